#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "plumb/structures.h"
#include "same_bits/answers.h"
#include "same_bits/entries.h"
#include "same_bits/table.h"
#include "support/effort.h"
#include "support/fp_modes.h"
#include "support/random.h"

// Every structure on every instruction set, in every way of asking, against one table of hashes that is the
// same on every machine. same_bits_truth_test shows that the table is what exact arithmetic says.

using namespace plumb;
using same_bits::Asking;
using same_bits::Entry;
using same_bits::Part;
using same_bits::Row;

namespace {

// Names a file to write the table to, instead of checking it.
const char* path_to_write() { return std::getenv("PLUMB_WRITE_SAME_BITS"); }

std::string hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016llxu", static_cast<unsigned long long>(value));
  return text;
}

// Where nothing is known of the entry, hashes that no entry has.
Row row_of(const Entry& entry) {
  const auto table = same_bits::table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Row& row) { return row.name == entry.name; });
  return found == table.end() ? Row{} : *found;
}

void check(const Entry& entry, const std::string& how, const std::string& what, std::uint64_t Row::*hash,
           std::uint64_t got) {
  const std::uint64_t expected = row_of(entry).*hash;
  CHECK_MESSAGE(got == expected,
                "\"" << entry.name << "\", " << what << ", by " << how << ": expected " << hex(expected)
                     << ", got " << hex(got)
                     << "\nWas the scene changed on purpose? The table anew: "
                        "PLUMB_WRITE_SAME_BITS=tests/same_bits/table.inc build/gcc/tests/same_bits_test");
}

// ---- What answers.

struct Method {
  int width;
  Simd simd;
  Quality quality = Quality::Balanced;

  std::string name() const {
    static constexpr const char* kQualities[] = {"fast", "balanced", "best"};
    return "bvh" + std::to_string(width) + " " + std::string(simd_name(simd)) + ", quality " +
           kQualities[static_cast<int>(quality)];
  }
};

Bvh tree(const Part& part, const Method& method, int threads = 1) {
  BuildOptions options;
  options.quality = method.quality;
  options.width = method.width;
  options.simd = method.simd;
  options.threads = threads;
  return Bvh(part.mesh, options);
}

// One in all for width 2, which is scalar code; qualities by turns.
std::vector<Method> trees() {
  std::vector<Method> result{{2, simd_targets().back()}};
  for (const int width : {4, 8}) {
    for (const Simd simd : simd_targets()) {
      result.push_back({width, simd, static_cast<Quality>(result.size() % 3)});
    }
  }
  return result;
}

// The answers of Arithmetic::Fast and Watertight may depend on the tree, so it is one tree.
std::uint64_t hash_of_inexact(const Entry& entry, Arithmetic arithmetic, Simd simd, Asking asking = {}) {
  asking.surfaces = false;
  const auto make = [&](const Part& part) {
    BuildOptions options;
    options.width = 8;
    options.threads = asking.threads;
    options.simd = simd;
    options.arithmetic = arithmetic;
    return Bvh(part.mesh, options);
  };
  return hash_of_rays(entry, make, asking);
}

Frame cast_frame(const Part& part, const Camera& camera, const Method& method, int threads = 1,
                 CastMethod way = CastMethod::Rays) {
  Frame frame(camera.width, camera.height);
  cast(tree(part, method, threads), camera, frame, {.threads = threads, .method = way});
  return frame;
}

Frame raster_frame(const Part& part, const Camera& camera, Simd simd, int threads = 1) {
  RasterOptions options;
  options.simd = simd;
  options.threads = threads;
  Frame frame(camera.width, camera.height);
  rasterize(part.mesh, camera, frame, options);
  return frame;
}

// The mesh in pieces of `count` triangles, the last one first.
Frame raster_pieces(const Part& part, const Camera& camera, Simd simd, std::size_t count) {
  RasterOptions options;
  options.simd = simd;
  options.threads = 1;
  Rasterizer rasterizer(camera, options);
  const MeshView whole = part.mesh;
  for (std::size_t end = whole.triangles.size(); end > 0;) {
    const std::size_t begin = end > count ? end - count : 0;
    rasterizer.draw({whole.positions, whole.triangles.subspan(begin, end - begin)},
                    static_cast<std::uint32_t>(begin));
    end = begin;
  }
  Frame frame(camera.width, camera.height);
  rasterizer.resolve(frame);
  return frame;
}

// ---- Orders of rays.

std::vector<std::size_t> reversed(std::size_t count) {
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = count - 1 - i;
  return order;
}

std::vector<std::size_t> shuffled(std::size_t count) {
  std::vector<std::size_t> order = reversed(count);
  hard::Random(3).shuffle(order);
  return order;
}

// Calls `visit` with every entry, or under the sanitizers with some, and its number, to take turns by.
void each_entry(const std::function<void(const Entry&, std::size_t turn)>& visit) {
  if (path_to_write() != nullptr) return;
  const std::vector<Entry>& all = same_bits::entries();
  for (std::size_t i = 0; i < all.size(); i += hard::kEffortDivisor) visit(all[i], i);
}

const auto brute = [](const Part& part) { return BruteForce(part.mesh); };

void write_table(std::ostream& out) {
  for (const Entry& entry : same_bits::entries()) {
    const std::uint64_t rays = hash_of_rays(entry, brute);
    const std::uint64_t frames = hash_of_frames(entry, [](const Part& part, const Camera& camera) {
      Frame frame(camera.width, camera.height);
      cast(BruteForce(part.mesh), camera, frame);
      return frame;
    });
    const Simd simd = simd_targets().front();
    out << "{\"" << entry.name << "\", " << hex(hash_of_inputs(entry)) << ", " << hex(rays) << ", "
        << hex(frames) << ", " << hex(hash_of_inexact(entry, Arithmetic::Fast, simd)) << ", "
        << hex(hash_of_inexact(entry, Arithmetic::Watertight, simd)) << "},\n";
  }
}

}  // namespace

TEST_SUITE("same bits") {
  TEST_CASE("the table is about these entries, and their scenes, rays and cameras are its own") {
    if (path_to_write() != nullptr) {
      std::ofstream out(path_to_write());
      write_table(out);
      REQUIRE(out.good());
      return;
    }
    CHECK(same_bits::table().size() == same_bits::entries().size());
    for (const Entry& entry : same_bits::entries()) {
      check(entry, "this compiler", "the scene itself", &Row::inputs, hash_of_inputs(entry));
    }
  }

  TEST_CASE("one bit of a depth or an id is another hash") {
    const Entry& entry = same_bits::entries().front();
    Frame frame = raster_frame(entry.parts.front(), entry.parts.front().cameras.front(), Simd::Auto);
    const auto hash = [&] {
      return hash_of_frames(entry, [&](const Part&, const Camera&) { return frame; });
    };
    const std::uint64_t before = hash();
    frame.id[17] ^= 1u;
    CHECK(hash() != before);
    frame.id[17] ^= 1u;
    CHECK(hash() == before);
    frame.depth[17] = std::nextafter(frame.depth[17], 0.0f);
    CHECK(hash() != before);
  }

  TEST_CASE("rays: by structures of every kind, width and instruction set") {
    each_entry([](const Entry& entry, std::size_t) {
      check(entry, "brute force", "rays", &Row::rays, hash_of_rays(entry, brute));
      for (const Method& method : trees()) {
        const auto make = [&](const Part& part) { return tree(part, method); };
        check(entry, method.name(), "rays", &Row::rays, hash_of_rays(entry, make));
      }
      for (const StructureKind kind : structure_kinds()) {
        for (const Simd simd : simd_targets()) {
          const auto make = [&](const Part& part) {
            StructureSettings settings;
            settings.kind = kind;
            settings.simd = simd;
            return build_structure(part.mesh, settings);
          };
          check(entry, std::string(structure_kind_name(kind)) + " " + std::string(simd_name(simd)), "rays",
                &Row::rays, hash_of_rays(entry, make));
        }
      }
    });
  }

  TEST_CASE("rays: by the arithmetics that are not exact, on every instruction set") {
    each_entry([](const Entry& entry, std::size_t turn) {
      for (const Simd simd : simd_targets()) {
        const int threads = static_cast<int>(turn++ % 4) + 1;
        const Asking asking{turn % 3 * 5, turn % 2 == 0 ? &shuffled : nullptr, threads};
        const std::string how = std::string(simd_name(simd)) + " on " + std::to_string(threads) + " threads";
        check(entry, "fast " + how, "rays", &Row::fast,
              hash_of_inexact(entry, Arithmetic::Fast, simd, asking));
        check(entry, "watertight " + how, "rays", &Row::watertight,
              hash_of_inexact(entry, Arithmetic::Watertight, simd, asking));
      }
    });
  }

  TEST_CASE(
      "frames: by rays and tiles through trees of every width and by the rasterizer, on every instruction "
      "set") {
    each_entry([](const Entry& entry, std::size_t) {
      for (const Method& method : trees()) {
        check(entry, method.name(), "frames", &Row::frames,
              hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return cast_frame(part, camera, method);
              }));
        if (method.width == 2) continue;
        check(entry, "tiles of " + method.name(), "frames", &Row::frames,
              hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return cast_frame(part, camera, method, 1, CastMethod::Tiles);
              }));
      }
      for (const Simd simd : simd_targets()) {
        check(entry, "raster " + std::string(simd_name(simd)), "frames", &Row::frames,
              hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return raster_frame(part, camera, simd);
              }));
      }
    });
  }

  TEST_CASE("rays cut into spans of any length, in any order") {
    constexpr std::size_t kBatches[] = {1, 3, 7, 64, 1000};
    each_entry([&](const Entry& entry, std::size_t turn) {
      const std::vector<Method> methods = trees();
      for (const std::size_t batch : kBatches) {
        for (const auto order : {&reversed, &shuffled}) {
          const Method& method = methods[turn++ % methods.size()];
          const auto make = [&](const Part& part) { return tree(part, method); };
          const Asking asking{batch, order, 1};
          check(entry, method.name() + " in spans of " + std::to_string(batch), "rays", &Row::rays,
                hash_of_rays(entry, make, asking));
        }
      }
    });
  }

  TEST_CASE("triangles drawn in pieces, the last ones first") {
    each_entry([&](const Entry& entry, std::size_t turn) {
      const std::vector<Simd> targets = simd_targets();
      for (const std::size_t count : {1u, 5u, 100u}) {
        if (count == 1 && entry.parts.front().mesh.triangles.size() > 100) continue;
        const Simd simd = targets[turn++ % targets.size()];
        check(entry, "raster " + std::string(simd_name(simd)) + " in pieces of " + std::to_string(count),
              "frames", &Row::frames, hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return raster_pieces(part, camera, simd, count);
              }));
      }
    });
  }

  TEST_CASE("one to eight threads that ask, build, cast and draw") {
    // More than this machine may have, so that their order varies.
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 8);
    each_entry([](const Entry& entry, std::size_t turn) {
      const std::vector<Method> methods = trees();
      const std::vector<Simd> targets = simd_targets();
      for (int threads = 1; threads <= 8; ++threads, ++turn) {
        const Method& method = methods[turn % methods.size()];
        const Simd simd = targets[turn % targets.size()];
        const std::string with = " on " + std::to_string(threads) + " threads";
        const auto make = [&](const Part& part) { return tree(part, method, threads); };
        check(entry, method.name() + with, "rays", &Row::rays,
              hash_of_rays(entry, make, {turn % 2 * 5, nullptr, threads}));
        // A few of both are enough for frames.
        if (turn % 3 != 0) continue;
        check(entry, method.name() + with, "frames", &Row::frames,
              hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return cast_frame(part, camera, method, threads, CastMethod::Auto);
              }));
        check(entry, "raster " + std::string(simd_name(simd)) + with, "frames", &Row::frames,
              hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
                return raster_frame(part, camera, simd, threads);
              }));
      }
    });
  }

  TEST_CASE("whatever floating-point mode the caller has set") {
    each_entry([](const Entry& entry, std::size_t turn) {
      const std::vector<Method> methods = trees();
      const std::vector<Simd> targets = simd_targets();
      for (const hard::NamedFpMode& mode : hard::kFpModes) {
        const Method& method = methods[turn % methods.size()];
        const Simd simd = targets[turn++ % targets.size()];
        std::uint64_t rays = 0, cast = 0, drawn = 0, fast = 0, watertight = 0;
        hard::under_mode(mode.bits, [&] {
          rays = hash_of_rays(entry, [&](const Part& part) { return tree(part, method); });
          cast = hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
            return cast_frame(part, camera, method, 1, turn % 2 == 0 ? CastMethod::Rays : CastMethod::Auto);
          });
          drawn = hash_of_frames(entry, [&](const Part& part, const Camera& camera) {
            return raster_frame(part, camera, simd);
          });
        });
        hard::under_mode(mode.bits, [&] {
          fast = hash_of_inexact(entry, Arithmetic::Fast, simd);
          watertight = hash_of_inexact(entry, Arithmetic::Watertight, simd);
        });
        const std::string with = std::string(" with ") + mode.name;
        check(entry, "fast" + with, "rays", &Row::fast, fast);
        check(entry, "watertight" + with, "rays", &Row::watertight, watertight);
        check(entry, method.name() + with, "rays", &Row::rays, rays);
        check(entry, method.name() + with, "frames", &Row::frames, cast);
        check(entry, "raster " + std::string(simd_name(simd)) + with, "frames", &Row::frames, drawn);
      }
    });
  }
}
