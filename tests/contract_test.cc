#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "plumb/plumb.h"
#include "support/print.h"

// What the public headers promise of progress, errors and copies, where no other test holds it.

using namespace plumb;

namespace {

const BuiltinScene& scene() {
  static const BuiltinScene made = builtin_scene("terrain:20000");
  return made;
}

constexpr int kWidth = 320;
constexpr int kHeight = 180;

Bvh build(int threads, const std::function<bool(double)>& progress = nullptr) {
  BuildOptions options;
  options.threads = threads;
  options.progress = progress;
  return Bvh(scene().mesh, options);
}

using Progress = std::function<bool(double)>;

struct Call {
  const char* name;
  std::function<void(int threads, const Progress&)> run;
};

// Every call that tells its progress.
std::vector<Call> calls() {
  const auto camera = [] { return scene().camera(kWidth, kHeight); };
  return {{"Bvh", [](int threads, const Progress& progress) { build(threads, progress); }},
          {"cast",
           [camera](int threads, const Progress& progress) {
             Frame frame(kWidth, kHeight);
             cast(build(1), camera(), frame, {.threads = threads, .progress = progress});
           }},
          {"rasterize", [camera](int threads, const Progress& progress) {
             Frame frame(kWidth, kHeight);
             RasterOptions options;
             options.threads = threads;
             options.progress = progress;
             rasterize(scene().mesh, camera(), frame, options);
           }}};
}

// A frame with something in it, to see that a call leaves it alone.
Frame marked_frame() {
  Frame frame(kWidth, kHeight);
  for (std::size_t i = 0; i < frame.id.size(); ++i) frame.id[i] = static_cast<std::uint32_t>(i);
  return frame;
}

}  // namespace

TEST_SUITE("contract") {
  TEST_CASE("progress rises within 0 to 1 on any number of threads") {
    for (const Call& call : calls()) {
      for (const int threads : {1, 2, 0}) {
        CAPTURE(call.name);
        CAPTURE(threads);
        double last = 0.0;
        bool rising = true;
        int count = 0;
        call.run(threads, [&](double share) {
          rising = rising && share >= last && share <= 1.0;
          last = share;
          ++count;
          return true;
        });
        CHECK(rising);
        CHECK(count > 5);
        CHECK(last > 0.9);
      }
    }
  }

  TEST_CASE("a callback's false is Cancelled, and what it throws comes out") {
    for (const Call& call : calls()) {
      for (const int threads : {1, 2}) {
        CAPTURE(call.name);
        CAPTURE(threads);
        CHECK_THROWS_AS(call.run(threads, [](double share) { return share < 0.3; }), Cancelled);
        CHECK_THROWS_WITH_AS(call.run(threads, [](double) -> bool { throw std::runtime_error("enough"); }),
                             "enough", std::runtime_error);
      }
    }
  }

  TEST_CASE("an error of cast or rasterize leaves the frame as it was") {
    const Bvh bvh = build(1);
    const Camera camera = scene().camera(kWidth, kHeight);
    const auto unchanged_after_error = [&](const auto& call, Frame frame) {
      const Frame before = frame;
      CHECK_THROWS_AS(call(frame), Error);
      CHECK(frame.depth == before.depth);
      CHECK(frame.id == before.id);
    };
    const auto cast_all = [&](Frame& frame) { cast(bvh, camera, frame, {.threads = -1}); };
    unchanged_after_error(cast_all, marked_frame());
    RasterOptions options;
    options.threads = -1;
    const auto draw = [&](Frame& frame) { rasterize(scene().mesh, camera, frame, options); };
    unchanged_after_error(draw, marked_frame());
    TriangleMesh broken = scene().mesh;
    broken.triangles.back().y = 0xffffffffu;
    const auto draw_broken = [&](Frame& frame) { rasterize(broken, camera, frame); };
    unchanged_after_error(draw_broken, marked_frame());

    // A frame that was resized by hand.
    Frame torn = marked_frame();
    torn.id.pop_back();
    unchanged_after_error([&](Frame& frame) { cast(bvh, camera, frame); }, torn);
    unchanged_after_error([&](Frame& frame) { cast(BruteForce({}), camera, frame); }, torn);
    unchanged_after_error([&](Frame& frame) { rasterize(scene().mesh, camera, frame); }, torn);
    unchanged_after_error([&](Frame& frame) { Rasterizer(camera).resolve(frame); }, torn);
  }

  TEST_CASE("a tree or a frame's rays can be had on any instruction set, with the same answer") {
    const Camera camera = scene().camera(kWidth, kHeight);
    for (const int width : {2, 4, 8}) {
      BuildOptions options;
      options.width = width;
      options.simd = simd_targets().back();
      const Bvh bvh(scene().mesh, options);
      Frame expected(kWidth, kHeight);
      cast(bvh, camera, expected);
      for (const Simd simd : simd_targets()) {
        CAPTURE(width);
        CAPTURE(simd_name(simd));
        Frame frame = marked_frame();
        cast(bvh, camera, frame, {.simd = simd});
        CHECK(compare(frame, expected).equal());
        const Bvh other = bvh.with_simd(simd);
        CHECK(other.closest(camera.ray(5, 5)) == bvh.closest(camera.ray(5, 5)));
        CHECK(other.statistics().bytes == bvh.statistics().bytes);
      }
    }
  }

  TEST_CASE("an instruction set that is not there is an error that lists those that are") {
    const std::vector<Simd> targets = simd_targets();
    Simd missing = Simd::Sve;
    if (std::find(targets.begin(), targets.end(), missing) != targets.end()) missing = Simd::Avx2;
    const Camera camera = scene().camera(kWidth, kHeight);
    const Bvh bvh = build(1);
    Frame frame = marked_frame();
    CHECK_THROWS_AS(cast(bvh, camera, frame, {.simd = missing}), Error);
    CHECK_THROWS_AS(cast(BruteForce({}), camera, frame, {.simd = missing}), Error);
    CHECK_THROWS_AS(bvh.with_simd(missing), Error);
    CHECK(frame.id == marked_frame().id);
  }

  TEST_CASE("options are named in their order, and no quality changes an answer") {
    const Camera camera = scene().camera(kWidth, kHeight);
    Frame expected(kWidth, kHeight), frame(kWidth, kHeight);
    cast(build(1), camera, expected);
    for (const Quality quality : {Quality::Fast, Quality::Balanced, Quality::Best}) {
      for (const int width : {2, 4, 8}) {
        double last = 0.0;
        const Bvh bvh(scene().mesh, {.quality = quality,
                                     .width = width,
                                     .threads = 1,
                                     .arithmetic = Arithmetic::Exact,
                                     .simd = Simd::Auto,
                                     .first_id = 0,
                                     .progress = [&](double share) {
                                       last = share;
                                       return true;
                                     }});
        cast(bvh, camera, frame);
        CHECK(compare(frame, expected).equal());
        CHECK(last > 0.9);
      }
    }
    const BuildOptions defaults;
    CHECK(defaults.quality == Quality::Balanced);
    CHECK(defaults.arithmetic == Arithmetic::Exact);
  }

  TEST_CASE("a copy shares its tree and outlives the original, and the mesh is not needed any more") {
    const Ray ray{{0.25f, 0.25f, -1.0f}, 0.0f, {0.0f, 0.0f, 1.0f}, INFINITY};
    TriangleMesh mesh{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}};
    Bvh original(mesh);
    BruteForce original_brute(mesh);
    mesh = {};
    const Bvh copy = original;
    const BruteForce copy_brute = original_brute;
    original = Bvh(mesh);
    original_brute = BruteForce(mesh);
    CHECK(copy.closest(ray) == Hit{2.0f, 0});
    CHECK(copy_brute.closest(ray) == Hit{2.0f, 0});
    CHECK(original.closest(ray) == Hit{});
    CHECK(original_brute.closest(ray) == Hit{});

    const Camera camera = Camera::look_at({0, 0, -1}, {0, 0, 1}, {0, 1, 0}, 40.0, 8, 8);
    Rasterizer rasterizer(camera);
    rasterizer.draw(TriangleMesh{{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}}, {{0, 1, 2}}});
    Rasterizer taken = std::move(rasterizer);
    Frame frame(8, 8);
    taken.resolve(frame);
    CHECK(frame.id[8 * 4 + 4] == 0);
    rasterizer = Rasterizer(camera);
    Frame empty(8, 8);
    rasterizer.resolve(empty);
    CHECK(empty.id == Frame(8, 8).id);
  }

  TEST_CASE("resolving again changes nothing, and what is drawn later is added") {
    const Camera camera = scene().camera(kWidth, kHeight);
    const TriangleMesh& mesh = scene().mesh;
    const auto half = static_cast<std::ptrdiff_t>(mesh.triangles.size() / 2);
    const TriangleMesh front{mesh.positions, {mesh.triangles.begin(), mesh.triangles.begin() + half}};
    const TriangleMesh back{mesh.positions, {mesh.triangles.begin() + half, mesh.triangles.end()}};
    Rasterizer rasterizer(camera);
    Frame frame(kWidth, kHeight), whole(kWidth, kHeight);
    rasterizer.draw(back, static_cast<std::uint32_t>(half));
    rasterizer.resolve(frame);
    const Frame once = frame;
    rasterizer.resolve(frame);
    CHECK(compare(frame, once).equal());
    rasterizer.draw(front, 0);
    rasterizer.resolve(frame);
    rasterize(mesh, camera, whole);
    CHECK(compare(frame, whole).equal());
  }
}
