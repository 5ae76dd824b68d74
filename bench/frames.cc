// Camera frames by every method, width and SIMD target, and the builds they need.
//
//     plumb_bench [SCENE...] [--benchmark_filter=...]
//
// SCENE is builtin:NAME[:SIZE] or, where plumb::io is built, a mesh file; without any, the built-in
// scenes. Frames are 1280x720 on one thread, seen by the scene's own camera. Every frame is compared
// with the binary BVH's before its time counts; one that differs is reported as an error.

#include <benchmark/benchmark.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#ifdef PLUMB_BENCH_FILES
#include "plumb/io.h"
#endif

namespace {

using namespace plumb;

constexpr int kWidthPx = 1280;
constexpr int kHeightPx = 720;
constexpr double kPixels = double{kWidthPx} * double{kHeightPx};

// A scene, its view, and the frame that every method must give; trees are built when first asked for.
class Scene {
 public:
  explicit Scene(const std::string& name) : name_(name), camera_(frame_all(MeshView(), kWidthPx, kHeightPx)) {
    constexpr std::string_view kBuiltin = "builtin:";
    if (name.rfind(kBuiltin, 0) == 0) {
      BuiltinScene scene = builtin_scene(name.substr(kBuiltin.size()));
      camera_ = scene.camera(kWidthPx, kHeightPx);
      mesh_ = std::move(scene.mesh);
    } else {
#ifdef PLUMB_BENCH_FILES
      mesh_ = load_mesh(name);
      camera_ = frame_all(mesh_, kWidthPx, kHeightPx);
#else
      throw Error("plumb_bench: '" + name + "': built without plumb::io, so only builtin:NAME can be timed");
#endif
    }
  }

  const std::string& name() const { return name_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const Camera& camera() const { return camera_; }

  const Frame& reference() {
    if (!reference_) {
      BuildOptions options;
      options.width = 2;
      reference_.emplace(kWidthPx, kHeightPx);
      cast(Bvh(mesh_, options), camera_, *reference_);
    }
    return *reference_;
  }

 private:
  std::string name_;
  TriangleMesh mesh_;
  Camera camera_;
  std::optional<Frame> reference_;
};

using ScenePointer = std::shared_ptr<Scene>;

BuildOptions build_options(int width, Simd simd) {
  BuildOptions options;
  options.width = width;
  options.simd = simd;
  options.threads = 1;
  return options;
}

void time_build(benchmark::State& state, const ScenePointer& scene, int width) {
  for (auto _ : state) {
    const Bvh bvh(scene->mesh(), build_options(width, Simd::Auto));
    benchmark::DoNotOptimize(&bvh);
  }
  state.counters["triangles"] = static_cast<double>(scene->mesh().triangles.size());
}

template <typename Draw>
void time_frame(benchmark::State& state, const ScenePointer& scene, const Draw& draw) {
  Frame frame(kWidthPx, kHeightPx);
  draw(frame);
  if (!compare(frame, scene->reference()).equal()) {
    state.SkipWithError("the frame differs from the binary BVH's");
    return;
  }
  for (auto _ : state) {
    draw(frame);
    benchmark::DoNotOptimize(frame.depth.data());
  }
  state.counters["pixels/s"] = benchmark::Counter(kPixels, benchmark::Counter::kIsIterationInvariantRate);
}

void time_cast(benchmark::State& state, const ScenePointer& scene, int width, Simd simd) {
  const Bvh bvh(scene->mesh(), build_options(width, simd));
  CastOptions options;
  options.threads = 1;
  time_frame(state, scene, [&](Frame& frame) { cast(bvh, scene->camera(), frame, options); });
}

void time_raster(benchmark::State& state, const ScenePointer& scene, Simd simd) {
  RasterOptions options;
  options.threads = 1;
  options.simd = simd;
  time_frame(state, scene, [&](Frame& frame) {
    frame.clear();
    rasterize(scene->mesh(), scene->camera(), frame, options);
  });
}

template <typename Work>
void add(const std::string& name, const Work& work) {
  benchmark::RegisterBenchmark(name.c_str(), work)->Unit(benchmark::kMillisecond);
}

void add_scene(const std::string& name) {
  const ScenePointer scene = std::make_shared<Scene>(name);
  for (const int width : {2, 4, 8}) {
    const std::string bvh = "/bvh" + std::to_string(width);
    add("build" + bvh + "/" + name, [=](benchmark::State& state) { time_build(state, scene, width); });
    for (const Simd simd : simd_targets()) {
      const std::string target = width == 2 ? "" : "/" + std::string(simd_name(simd));
      add("frame" + bvh + target + "/" + name,
          [=](benchmark::State& state) { time_cast(state, scene, width, simd); });
      if (width == 2) break;  // plain scalar code: the target does not matter
    }
  }
  for (const Simd simd : simd_targets()) {
    add("frame/raster/" + std::string(simd_name(simd)) + "/" + name,
        [=](benchmark::State& state) { time_raster(state, scene, simd); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    for (int i = 1; i < argc; ++i) add_scene(argv[i]);
    if (argc == 1) {
      for (const plumb::BuiltinInfo& info : plumb::builtin_scenes()) add_scene("builtin:" + info.name);
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
