#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "plumb/error.h"
#include "plumb/raster.h"
#include "raster_util.h"
#include "support/fp_modes.h"
#include "support/random.h"

// How frames are put together: many draws, merging, cancelling, errors, the caller's state.

using namespace plumb;
using namespace plumb::raster_test;

namespace {

// Overlapping triangles of several sizes; some twice, so that ids decide.
TriangleMesh scene(std::uint64_t seed, int count) {
  hard::Random random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    if (i % 5 == 4) {
      mesh.triangles.push_back(random.pick(mesh.triangles));
      continue;
    }
    const glm::vec3 centre = random.unit3();
    const float size = random.one_in(4) ? 1.0f : 0.2f;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int v = 0; v < 3; ++v) mesh.positions.push_back(centre + size * random.unit3());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

Camera camera_of(int width, int height) {
  return Camera::look_at({0.3f, 0.4f, 2.5f}, {0, 0, 0}, {0, 1, 0}, 55.0, width, height);
}

MeshView part(const TriangleMesh& mesh, std::size_t first, std::size_t last) {
  return MeshView(mesh.positions, std::span<const glm::uvec3>(mesh.triangles).subspan(first, last - first));
}

}  // namespace

TEST_SUITE("raster: draws") {
  TEST_CASE("what is tested is counted; how many triangles tiles may see, alike on every instruction set") {
    const TriangleMesh mesh = scene(1, 300);
    const Camera camera = camera_of(83, 61);
    const RasterCounts counts = count_raster_tests(mesh, camera);
    CHECK(counts.triangles == 300);
    CHECK(counts.tiles > 300);
    CHECK(counts.tiles_hidden < counts.tiles);
    CHECK(counts.blocks > 0);
    CHECK(counts.blocks_full < counts.blocks);
    CHECK(counts.blocks_full > 0);
    CHECK(counts.pixels_decided > 0);  // of a fifth of the triangles there is a second
    for (const Simd simd : simd_targets()) {
      RasterOptions options;
      options.simd = simd;
      options.threads = 3;
      const RasterCounts other = count_raster_tests(mesh, camera, options);
      CHECK(other.tiles == counts.tiles);
      CHECK(other.tiles_hidden < other.tiles);  // triangles are drawn a vector at a time
    }
    // One triangle over the whole view: each of its blocks is covered, and tested once.
    const TriangleMesh wall{{{-99, -99, 0}, {99, -99, 0}, {0, 199, 0}}, {{0, 1, 2}}};
    const RasterCounts of_wall = count_raster_tests(wall, camera_of(64, 32));
    CHECK(of_wall.tiles == 2);
    CHECK(of_wall.blocks == 2 * 64);
    CHECK(of_wall.blocks_full == 2 * 64);
    CHECK(of_wall.pixels_decided == 0);
    CHECK_THROWS_AS(count_raster_tests(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}, camera), Error);
  }

  TEST_CASE("parts drawn in any order, and drawn twice, give the whole") {
    const TriangleMesh mesh = scene(1, 300);
    const Camera camera = camera_of(83, 61);
    const Frame expected = brute_force_frame(mesh, camera);
    hard::Random random(2);
    for (int repeat = 0; repeat < 6; ++repeat) {
      CAPTURE(repeat);
      std::vector<std::size_t> starts;
      const std::size_t step = 1 + random.below(90);
      for (std::size_t i = 0; i < mesh.triangles.size(); i += step) starts.push_back(i);
      if (repeat % 2 == 1) starts.push_back(random.pick(starts));
      random.shuffle(starts);
      Rasterizer rasterizer(camera);
      for (const std::size_t first : starts) {
        const std::size_t last = std::min(first + step, mesh.triangles.size());
        rasterizer.draw(part(mesh, first, last), static_cast<std::uint32_t>(first));
      }
      Frame frame(camera.width, camera.height);
      rasterizer.resolve(frame);
      check_frame(frame, expected);
    }
  }

  TEST_CASE("more triangles than are set up at a time give the whole") {
    // The same few triangles again and again: the first of each wins.
    const TriangleMesh few = scene(3, 40);
    TriangleMesh mesh = few;
    while (mesh.triangles.size() < 600000)
      mesh.triangles.insert(mesh.triangles.end(), few.triangles.begin(), few.triangles.end());
    const Camera camera = camera_of(19, 13);
    check_frame(raster_frame(mesh, camera), brute_force_frame(few, camera));
  }

  TEST_CASE("nothing needs the mesh after draw has returned") {
    const TriangleMesh mesh = scene(4, 100);
    const Camera camera = camera_of(70, 50);
    Rasterizer rasterizer(camera);
    {
      TriangleMesh copy = mesh;
      rasterizer.draw(copy);
      std::fill(copy.positions.begin(), copy.positions.end(), glm::vec3(0.0f));
    }
    Frame frame(camera.width, camera.height);
    rasterizer.resolve(frame);
    check_frame(frame, brute_force_frame(mesh, camera));
  }

  TEST_CASE("resolving merges into the frame by (t, id), as often as one likes") {
    const TriangleMesh first = scene(5, 60), second = scene(6, 60);
    const Camera camera = camera_of(65, 40);
    for (const auto& [id_a, id_b] : {std::pair<std::uint32_t, std::uint32_t>{0, 60}, {kNone - 60, 7}}) {
      Frame expected = brute_force_frame(first, camera, id_a);
      brute_force_merge(second, camera, expected, id_b);
      Frame frame(camera.width, camera.height);
      RasterOptions options;
      options.first_id = id_a;
      rasterize(first, camera, frame, options);
      Rasterizer rasterizer(camera, options);
      rasterizer.draw(second, id_b);
      rasterizer.resolve(frame);
      check_frame(frame, expected);
      rasterizer.resolve(frame);
      check_frame(frame, expected);
    }
  }

  TEST_CASE("equal triangles of two meshes go to the lower id, whichever is drawn first") {
    const TriangleMesh mesh = scene(7, 50);
    const Camera camera = camera_of(40, 40);
    const Frame expected = brute_force_frame(mesh, camera, 100);
    for (const bool lower_first : {false, true}) {
      Rasterizer rasterizer(camera);
      rasterizer.draw(mesh, lower_first ? 100 : 500);
      rasterizer.draw(mesh, lower_first ? 500 : 100);
      Frame frame(camera.width, camera.height);
      rasterizer.resolve(frame);
      check_frame(frame, expected);
    }
  }

  TEST_CASE("clear forgets, and a moved rasterizer goes on") {
    const TriangleMesh mesh = scene(8, 50), other = scene(9, 50);
    const Camera camera = camera_of(40, 40);
    Rasterizer first(camera);
    first.draw(other);
    first.clear();
    Frame frame(camera.width, camera.height);
    first.resolve(frame);
    check_frame(frame, Frame(camera.width, camera.height));
    first.draw(mesh);
    Rasterizer second(std::move(first));
    second.resolve(frame);
    check_frame(frame, brute_force_frame(mesh, camera));
  }

  TEST_CASE("an empty mesh and one that no pixel can see leave the frame as it was") {
    const float bad = std::numeric_limits<float>::quiet_NaN();
    TriangleMesh mesh;
    const Camera camera = camera_of(20, 20);
    check_frame(raster_frame(mesh, camera), Frame(20, 20));
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, bad, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 1, 1}};
    check_frame(raster_frame(mesh, camera), Frame(20, 20));
  }
}

TEST_SUITE("raster: progress") {
  TEST_CASE("progress rises to the end") {
    const TriangleMesh mesh = scene(10, 5000);
    const Camera camera = camera_of(160, 120);
    RasterOptions options;
    options.threads = 1;
    double last = 0.0;
    bool rising = true;
    options.progress = [&](double share) {
      rising = rising && share >= last && share <= 1.0;
      last = share;
      return true;
    };
    const Frame frame = raster_frame(mesh, camera, options);
    CHECK(rising);
    CHECK(last > 0.9);
    options.progress = nullptr;
    check_frame(frame, raster_frame(mesh, camera, options));
  }

  TEST_CASE("cancelling at any time takes the whole call back, and drawing can go on") {
    const TriangleMesh mesh = scene(11, 3000), other = scene(12, 200);
    const Camera camera = camera_of(160, 120);
    const Frame expected = raster_frame(other, camera);
    for (int calls = 0; calls < 8; ++calls) {
      CAPTURE(calls);
      RasterOptions options;
      bool cancel = false;
      int left = 0;
      options.progress = [&](double) { return !cancel || left-- > 0; };
      Rasterizer rasterizer(camera, options);
      rasterizer.draw(other);
      cancel = true;
      left = calls * 2;
      CHECK_THROWS_AS(rasterizer.draw(mesh), Cancelled);
      Frame frame(camera.width, camera.height);
      rasterizer.resolve(frame);
      check_frame(frame, expected);
      cancel = false;
      rasterizer.draw(mesh, 200);
      rasterizer.resolve(frame);
      Frame both = expected;
      RasterOptions plain;
      plain.first_id = 200;
      rasterize(mesh, camera, both, plain);
      check_frame(frame, both);
    }
  }

  TEST_CASE("a callback that throws takes the call back as well") {
    const TriangleMesh mesh = scene(13, 3000);
    const Camera camera = camera_of(160, 120);
    for (const int threads : {1, 2}) {
      RasterOptions options;
      options.threads = threads;
      int left = 3;
      options.progress = [&](double) -> bool {
        if (left-- == 0) throw std::runtime_error("enough");
        return true;
      };
      Rasterizer rasterizer(camera, options);
      CHECK_THROWS_WITH_AS(rasterizer.draw(mesh), "enough", std::runtime_error);
      Frame frame(camera.width, camera.height);
      rasterizer.resolve(frame);
      check_frame(frame, Frame(camera.width, camera.height));
    }
  }

  TEST_CASE("a cancelled rasterize leaves the frame as it was") {
    const TriangleMesh mesh = scene(14, 3000);
    const Camera camera = camera_of(160, 120);
    Frame frame(camera.width, camera.height);
    RasterOptions options;
    options.progress = [](double) { return false; };
    CHECK_THROWS_AS(rasterize(mesh, camera, frame, options), Cancelled);
    check_frame(frame, Frame(camera.width, camera.height));
  }
}

TEST_SUITE("raster: callers") {
  TEST_CASE("what a caller gets wrong is an Error that says so, and nothing is drawn") {
    TriangleMesh mesh = scene(15, 20);
    Camera camera = camera_of(16, 16);
    Frame frame(16, 16);
    const auto throws = [&](const std::string& text, const auto& call) {
      CAPTURE(text);
      CHECK_THROWS_WITH_AS(call(), doctest::Contains(text.c_str()), Error);
      check_frame(frame, Frame(16, 16));
    };
    mesh.triangles[7].y = 12345;
    throws("12345", [&] { rasterize(mesh, camera, frame); });
    mesh.triangles[7].y = 0;
    RasterOptions options;
    options.first_id = kNone - 19;
    throws("first_id", [&] { rasterize(mesh, camera, frame, options); });
    options.first_id = kNone - 20;
    CHECK_NOTHROW(Rasterizer(camera, options).draw(mesh));
    options = {};
    options.threads = -1;
    throws("threads", [&] { rasterize(mesh, camera, frame, options); });
    throws("threads", [&] { Rasterizer rasterizer(camera, options); });
    options = {};
    options.simd = Simd::Wasm;
    throws("wasm", [&] { rasterize(mesh, camera, frame, options); });
    Frame other(16, 17);
    throws("16x17", [&] { rasterize(mesh, camera, other); });
    throws("16x17", [&] { Rasterizer(camera).resolve(other); });
    other.height = 16;
    throws("272", [&] { rasterize(mesh, camera, other); });
    camera.width = 0;
    throws("0x16", [&] { rasterize(mesh, camera, frame); });
    throws("0x16", [&] { Rasterizer rasterizer(camera); });
  }

  TEST_CASE("the caller's floating-point mode changes nothing and is given back") {
    const TriangleMesh mesh = scene(16, 80);
    TriangleMesh small = mesh;
    for (glm::vec3& p : small.positions) p *= 0x1p-130f;
    Camera small_camera = camera_of(50, 30);
    small_camera.eye *= 0x1p-130f;
    for (glm::dvec3* v : {&small_camera.corner, &small_camera.du, &small_camera.dv}) *v *= 0x1p-131;
    const std::vector<std::pair<const TriangleMesh*, Camera>> views = {{&mesh, camera_of(50, 30)},
                                                                       {&small, small_camera}};
    for (const auto& view : views) {
      const auto& scene_mesh = view.first;
      const Camera& camera = view.second;
      const Frame expected = brute_force_frame(*scene_mesh, camera);
      CHECK(std::count(expected.id.begin(), expected.id.end(), kNone) < 1200);
      for (const hard::NamedFpMode& mode : hard::kFpModes) {
        for (const int threads : {1, 2}) {
          CAPTURE(mode.name);
          CAPTURE(threads);
          RasterOptions options;
          options.threads = threads;
          const Frame frame =
              hard::under_mode(mode.bits, [&] { return raster_frame(*scene_mesh, camera, options); });
          check_frame(frame, expected);
        }
      }
    }
  }
}
