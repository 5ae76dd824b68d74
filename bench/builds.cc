// The stages of a build, with Embree beside them where it is installed.
//
//     plumb_build_bench [SCENE...] [--benchmark_filter=...]
//
// SCENE is builtin:NAME[:SIZE] or, where plumb::io is built, a mesh file; without any, the built-in
// scenes. Names end in the number of threads. Times are those of the process's CPU for one thread, so that
// other programs on the machine disturb them little, and of the clock for more. `sah` is
// Statistics::sah_cost.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "build/binned_sah.h"
#include "build/mesh_check.h"
#include "build/tree_statistics.h"
#include "plumb/builtin.h"
#include "plumb/error.h"
#include "wide/collapse.h"
#ifdef PLUMB_BENCH_FILES
#include "plumb/io.h"
#endif
#ifdef PLUMB_BENCH_EMBREE
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace {

using namespace plumb;
using namespace plumb::detail;
using Mesh = std::shared_ptr<const TriangleMesh>;

Mesh load(const std::string& name) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (name.rfind(kBuiltin, 0) == 0) {
    return std::make_shared<TriangleMesh>(builtin_scene(name.substr(kBuiltin.size())).mesh);
  }
#ifdef PLUMB_BENCH_FILES
  return std::make_shared<TriangleMesh>(load_mesh(name));
#else
  throw Error("plumb_build_bench: '" + name +
              "': built without plumb::io, so only builtin:NAME can be timed");
#endif
}

BinaryTree build_binary(const TriangleMesh& mesh, int lanes, int threads) {
  BinnedSahOptions options;
  options.block = options.max_leaf = lanes;
  options.threads = threads;
  Progress progress(nullptr, mesh.triangles.size());
  check_mesh(mesh, 0, "plumb_build_bench");
  return build_binned_sah(mesh, options, progress);
}

template <typename Tree>
void report(benchmark::State& state, const TriangleMesh& mesh, const Tree& tree) {
  const Statistics statistics = tree_statistics(tree);
  const auto triangles = static_cast<double>(mesh.triangles.size());
  state.counters["sah"] = statistics.sah_cost;
  state.counters["depth"] = statistics.depth;
  state.counters["bytes/triangle"] = static_cast<double>(statistics.bytes) / triangles;
  state.counters["triangles/s"] =
      benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate);
}

void time_binary(benchmark::State& state, const Mesh& mesh, int lanes, int threads) {
  BinaryTree tree;
  for (auto _ : state) tree = build_binary(*mesh, lanes, threads);
  report(state, *mesh, tree);
}

template <int W>
void time_collapse(benchmark::State& state, const Mesh& mesh, int threads) {
  const BinaryTree binary = build_binary(*mesh, W, threads);
  WideTree<W> tree;
  for (auto _ : state) tree = collapse<W>(binary, *mesh, 0, threads);
  report(state, *mesh, tree);
}

template <int W>
void time_wide(benchmark::State& state, const Mesh& mesh, int threads) {
  WideTree<W> tree;
  for (auto _ : state) tree = collapse<W>(build_binary(*mesh, W, threads), *mesh, 0, threads);
  report(state, *mesh, tree);
}

#ifdef PLUMB_BENCH_EMBREE
// Its default quality: what rtcCommitScene takes to make the scene ready for rays.
void time_embree(benchmark::State& state, const Mesh& mesh, int threads) {
  const unsigned mode = _mm_getcsr();
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);  // as its manual asks
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto copy = [&](const auto& from, RTCBufferType type, RTCFormat format) {
    void* const to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(from[0]), from.size());
    std::copy(from.begin(), from.end(), static_cast<std::remove_cvref_t<decltype(from[0])>*>(to));
  };
  copy(mesh->positions, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3);
  copy(mesh->triangles, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3);
  rtcCommitGeometry(geometry);
  for (auto _ : state) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    rtcReleaseScene(scene);
  }
  rtcReleaseGeometry(geometry);
  rtcReleaseDevice(device);
  _mm_setcsr(mode);
}
#endif

void add(const std::string& name, int threads, const std::function<void(benchmark::State&)>& work) {
  auto* const bench = benchmark::RegisterBenchmark((name + "/" + std::to_string(threads)).c_str(), work);
  bench->Unit(benchmark::kMillisecond);
  if (threads == 1) {
    bench->MeasureProcessCPUTime();
  } else {
    bench->UseRealTime();
  }
}

void add_scene(const std::string& name, int threads) {
  const Mesh mesh = load(name);
  add("binary/" + name, threads, [=](benchmark::State& state) { time_binary(state, mesh, 1, threads); });
  add("binary8/" + name, threads, [=](benchmark::State& state) { time_binary(state, mesh, 8, threads); });
  add("collapse4/" + name, threads, [=](benchmark::State& state) { time_collapse<4>(state, mesh, threads); });
  add("collapse8/" + name, threads, [=](benchmark::State& state) { time_collapse<8>(state, mesh, threads); });
  add("bvh4/" + name, threads, [=](benchmark::State& state) { time_wide<4>(state, mesh, threads); });
  add("bvh8/" + name, threads, [=](benchmark::State& state) { time_wide<8>(state, mesh, threads); });
#ifdef PLUMB_BENCH_EMBREE
  add("embree/" + name, threads, [=](benchmark::State& state) { time_embree(state, mesh, threads); });
#endif
}

void add_scene_for_all_threads(const std::string& name) {
  add_scene(name, 1);
  if (thread_count(0) > 1) add_scene(name, thread_count(0));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    for (int i = 1; i < argc; ++i) add_scene_for_all_threads(argv[i]);
    if (argc == 1) {
      for (const plumb::BuiltinInfo& info : plumb::builtin_scenes()) {
        add_scene_for_all_threads("builtin:" + info.name);
      }
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
