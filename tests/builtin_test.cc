#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/error.h"
#include "scene/mesh_builder.h"
#include "scene/track.h"
#include "support/fp_modes.h"
#include "support/hash.h"

using namespace plumb;

namespace {

std::uint64_t hash_of(const BuiltinScene& scene) {
  hard::Hash hash;
  for (const glm::vec3& p : scene.mesh.positions) hash.add(p);
  for (const glm::uvec3& t : scene.mesh.triangles) hash.add(t);
  for (const glm::vec3& v : {scene.eye, scene.target, scene.up}) hash.add(v);
  return hash.value();
}

std::string message_of(const std::string& name) {
  try {
    builtin_scene(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

TEST_SUITE("built-in scenes") {
  struct Known {
    std::string name;
    std::uint64_t hash;
  };
  // By default and at another size.
  const Known kKnown[] = {
      {"teapot-in-stadium", 0xc039454b8d568825u},
      {"teapot-in-stadium:7000", 0x3f075334142ce827u},
      {"terrain", 0xa73f3667e30a25e2u},
      {"terrain:5000", 0x56f7d5d345e418c2u},
      {"grid", 0xd3f8ad77d9b6255fu},
      {"grid:45", 0x09bbb24540f93a7fu},
      {"grass", 0x85276f6087732cd2u},
      {"grass:5000", 0xe431acc840f84be6u},
      {"soup", 0x1d25c36b10348257u},
      {"soup:5000", 0xfd13361724ba3b70u},
      {"spheres", 0xf49a8d5171e0ff23u},
      {"spheres:5000", 0x12249ee0a2d5069fu},
      {"quads", 0x45acfcd47f58f125u},
      {"quads:10", 0x009d5fef6c5f8cddu},
      {"cornell", 0x6289aa7e858bc2b5u},
      {"cornell:5000", 0x137599ff710d6252u},
      {"ties", 0x2ab38d8d4abd0098u},
      {"ties:5000", 0x0b34a7e515ff6a53u},
  };

  TEST_CASE("every scene is the same bits everywhere, by default and at another size") {
    CHECK(std::size(kKnown) == 2 * builtin_scenes().size());
    for (const Known& known : kKnown) {
      CAPTURE(known.name);
      CHECK(hash_of(builtin_scene(known.name)) == known.hash);
    }
  }

  TEST_CASE("the caller's floating-point mode changes no bit") {
    for (const Known& known : kKnown) {
      if (known.name.find(':') == std::string::npos) continue;
      CAPTURE(known.name);
      const BuiltinScene scene =
          hard::under_mode(hard::kOddestFpMode, [&] { return builtin_scene(known.name); });
      CHECK(hash_of(scene) == known.hash);
    }
  }

  TEST_CASE("every scene is sound: indices in range, coordinates finite, a camera") {
    for (const BuiltinInfo& info : builtin_scenes()) {
      CAPTURE(info.name);
      const BuiltinScene scene = builtin_scene(info.name);
      REQUIRE_FALSE(scene.mesh.triangles.empty());
      const bool finite = std::all_of(scene.mesh.positions.begin(), scene.mesh.positions.end(), is_finite);
      CHECK(finite);
      std::vector<bool> used(scene.mesh.positions.size(), false);
      for (const glm::uvec3& t : scene.mesh.triangles) {
        for (int k = 0; k < 3; ++k) used.at(t[k]) = true;
      }
      const auto unused = std::count(used.begin(), used.end(), false);
      CHECK(unused <= static_cast<std::ptrdiff_t>(used.size() / 100));
      CHECK(scene.camera(1280, 720).width == 1280);
      CHECK(info.description.find('\n') == std::string::npos);
      CHECK(hash_of(scene) == hash_of(builtin_scene(info.name + ":" + std::to_string(info.default_size))));
    }
  }

  TEST_CASE("a size in triangles is met within a fifth") {
    for (const std::size_t size : {2'000u, 10'000u, 50'000u, 320'000u, 1'000'000u}) {
      for (const char* name :
           {"teapot-in-stadium:", "terrain:", "grass:", "soup:", "spheres:", "cornell:", "ties:"}) {
        CAPTURE(name);
        CAPTURE(size);
        const double triangles =
            static_cast<double>(builtin_scene(name + std::to_string(size)).mesh.triangles.size());
        CHECK(triangles > 0.8 * static_cast<double>(size));
        CHECK(triangles < 1.2 * static_cast<double>(size));
      }
    }
    CHECK(builtin_scene("terrain:2").mesh.triangles.size() == 2);
    CHECK(builtin_scene("terrain").mesh.triangles.size() == 500'000);
  }

  TEST_CASE("the grid has at least two triangles a block") {
    CHECK(builtin_scene("grid:1").mesh.triangles.size() >= 4);
    CHECK(builtin_scene("grid:64").mesh.triangles.size() >= 2 * (64 * 18 + 45 * 12));
  }

  TEST_CASE("an unknown name is an error that lists the known ones") {
    const std::string message = message_of("teapot");
    for (const BuiltinInfo& info : builtin_scenes()) CHECK(contains(message, info.name));
    CHECK(contains(message, "'teapot'"));
    CHECK(contains(message_of(""), "''"));
    CHECK(contains(message_of(":5"), "''"));
    CHECK(contains(message_of("Grid"), "'Grid'"));
  }

  TEST_CASE("a size that is no number or out of range is an error that names the range") {
    for (const char* size : {"", "x", "-5", "+5", " 5", "5 ", "5.5", "1e3", "0", "0x10", "4097", "5:5",
                             "99999999999999999999999999"}) {
      CAPTURE(size);
      CHECK(contains(message_of(std::string("grid:") + size), "from 1 to 4096"));
    }
    CHECK(contains(message_of("terrain:1"), "from 2 to 150000000"));
    CHECK(contains(message_of("terrain:150000001"), "from 2 to 150000000"));
    CHECK(contains(message_of("teapot-in-stadium:1999"), "from 2000 to 10000000"));
    CHECK(message_of("grid:1") == "no error");
    CHECK(message_of("teapot-in-stadium:2000") == "no error");
  }
}

TEST_SUITE("teapot-in-stadium") {
  TEST_CASE("the stadium is about a thousand times as long as the teapot") {
    const BuiltinScene scene = builtin_scene("teapot-in-stadium");
    float stadium = 0.0f;
    for (const glm::vec3& p : scene.mesh.positions) stadium = std::max(stadium, std::fabs(p.x));
    // The teapot is about 6.43 * 0.0375 long, as appended last.
    const glm::vec3& last = scene.mesh.positions.back();
    CHECK(std::fabs(last.x) < 0.25f);
    const float ratio = 2.0f * stadium / (6.43f * 0.0375f);
    CHECK(ratio > 900.0f);
    CHECK(ratio < 1200.0f);
  }

  TEST_CASE("painted lines, stripes and ground lie in one plane, lines first") {
    // What is seen where they overlap is the lower id, by the definition's rule.
    const TriangleMesh mesh = builtin_scene("teapot-in-stadium").mesh;
    std::size_t painted = 0;
    while (painted < mesh.triangles.size()) {
      const glm::uvec3& t = mesh.triangles[painted];
      if (mesh.positions[t.x].y != 0.0f || mesh.positions[t.y].y != 0.0f || mesh.positions[t.z].y != 0.0f)
        break;
      ++painted;
    }
    CHECK(painted > 1000);
  }
}

TEST_SUITE("grid") {
  // Where a ray is, along one axis, k * 2^17 below the eye.
  std::int64_t grid_place(int k, float component) {
    const double exact = k * 0x1p17 * double{component};
    REQUIRE(exact == std::floor(exact));
    return static_cast<std::int64_t>(exact);
  }

  TEST_CASE("coordinates are integers") {
    for (const glm::vec3& p : builtin_scene("grid:100").mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) REQUIRE(p[axis] == std::floor(p[axis]));
    }
  }

  TEST_CASE("pixel directions are exact dyadic fractions at the frame heights it is made for") {
    const BuiltinScene scene = builtin_scene("grid:8");
    for (const int height : {45, 90, 135, 180, 270, 360, 720, 1080, 2160, 256, 512, 1024}) {
      CAPTURE(height);
      const int width = height * 16 / 9;
      const Camera camera = scene.camera(width, height);
      int inexact = 0;
      for (int y = 0; y < height; y += 7) {
        for (int x = 0; x < width; x += 5) {
          const glm::vec3 d = camera.ray(x, y).direction;
          // Products of small integers: exact in double.
          const double scale = 256.0 * height;
          const bool exact = double{d.x} * scale == 135.0 * (2 * x + 1 - width) &&
                             double{d.y} * scale == 135.0 * (height - 1 - 2 * y) && d.z == -1.0f;
          inexact += exact ? 0 : 1;
        }
      }
      CHECK(inexact == 0);
    }
  }

  TEST_CASE("rays meet lines and diagonals of the tops as often as told") {
    // The height, the side of the blocks of the half that it is made for, and how many times rarer than
    // in every 7th, 9th and 21st column.
    struct {
      int height;
      std::int64_t side;
      int rarer;
    } const frames[] = {{720, 6048, 1},  {360, 6048, 1}, {180, 6048, 1},
                        {1080, 6048, 3}, {512, 8505, 1}, {256, 8505, 1}};
    for (const auto& frame : frames) {
      const int width = 4 * frame.height;
      const Camera camera = builtin_scene("grid:8").camera(width, frame.height);
      for (const auto& told : {std::pair{9, 7}, std::pair{7, 9}, std::pair{6, 21}}) {
        const int k = told.first;
        int columns = 0, diagonals = 0;
        for (int x = 0; x < width; ++x) {
          const glm::vec3 direction = camera.ray(x, 0).direction;
          columns += grid_place(k, direction.x) % frame.side == 0 ? 1 : 0;
          diagonals += (grid_place(k, direction.x) - grid_place(k, direction.y)) % frame.side == 0 ? 1 : 0;
        }
        const int expected = width / (told.second * frame.rarer);
        CAPTURE(frame.height);
        CAPTURE(k);
        CHECK(columns >= expected);
        CHECK(columns <= expected + 1);
        CHECK(diagonals >= expected);
        CHECK(diagonals <= expected + 1);
      }
    }
  }
}

TEST_SUITE("scene building") {
  TEST_CASE("turn gives cosine and sine of any share of a turn") {
    for (int i = -2000; i <= 2000; ++i) {
      const double share = i / 720.0;
      const detail::Turn turn = detail::turn(share);
      const double angle = 2.0 * std::numbers::pi * share;
      CHECK(turn.cos == doctest::Approx(std::cos(angle)).epsilon(1e-13).scale(1.0));
      CHECK(turn.sin == doctest::Approx(std::sin(angle)).epsilon(1e-13).scale(1.0));
    }
    CHECK(detail::turn(0.0).cos == 1.0);
    CHECK(detail::turn(0.25).cos == 0.0);
    CHECK(detail::turn(0.25).sin == 1.0);
    CHECK(detail::turn(-0.5).cos == -1.0);
    CHECK(detail::turn(1.75).sin == -1.0);
  }

  TEST_CASE("a track's spots are evenly spaced along it, with unit normals") {
    for (const detail::Track track : {detail::Track{35.0, 18.0, 30.0}, {0.0, 0.0, 2.0}, {5.0, 1.0, 0.5}}) {
      constexpr int kSpots = 20000;
      double length = 0.0, longest = 0.0;
      for (int i = 0; i < kSpots; ++i) {
        const detail::TrackSpot a = track.spot(static_cast<double>(i) / kSpots);
        const detail::TrackSpot b = track.spot(static_cast<double>((i + 1) % kSpots) / kSpots);
        const double step = std::hypot(b.x - a.x, b.z - a.z);
        length += step;
        longest = std::max(longest, step);
        CHECK(std::hypot(a.normal_x, a.normal_z) == doctest::Approx(1.0));
      }
      CHECK(length == doctest::Approx(track.length()).epsilon(1e-5));
      CHECK(longest == doctest::Approx(track.length() / kSpots).epsilon(1e-5));
    }
  }
}
