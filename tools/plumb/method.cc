#include "method.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/layers.h"
#include "plumb/raster.h"
#include "plumb/structures.h"
#include "text.h"

namespace plumb::tool {
namespace {

const MethodInfo& info(Method method) {
  const auto& methods = all_methods();
  return *std::find_if(methods.begin(), methods.end(),
                       [&](const MethodInfo& candidate) { return candidate.method == method; });
}

std::vector<Simd> parse_targets(std::string_view name) {
  std::vector<Simd> usable = simd_targets();
  if (name == "all") return usable;
  const Simd simd = parse_simd(name);
  if (simd == Simd::Auto) return {usable.front()};
  if (std::find(usable.begin(), usable.end(), simd) == usable.end()) {
    std::string names;
    for (const Simd target : usable) names.append(" ").append(simd_name(target));
    throw Error(fmt::format("plumb: --simd {}: this machine cannot run it; it has:{}", name, names));
  }
  return {simd};
}

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct DrawSettings {
  Simd simd;
  int threads;
  std::function<bool(double)> progress;
};

RasterOptions raster_options(const DrawSettings& settings) {
  RasterOptions options;
  options.threads = settings.threads;
  options.simd = settings.simd;
  options.progress = settings.progress;
  return options;
}

void take_layers(const LayeredFrame& made, RunResult& result) {
  result.frame = made.layer(0);
  for (int layer = 1; layer < made.layers; ++layer) result.behind.push_back(made.layer(layer));
}

void draw(MeshView mesh, const Camera& camera, int layers, const DrawSettings& settings, RunResult& result) {
  const RasterOptions options = raster_options(settings);
  if (layers == 1) {
    const Stopwatch watch;
    rasterize(mesh, camera, result.frame, options);
    result.frame_seconds = watch.seconds();
    return;
  }
  LayeredFrame made(camera.width, camera.height, layers);
  const Stopwatch watch;
  rasterize_layers(mesh, camera, made, options);
  result.frame_seconds = watch.seconds();
  take_layers(made, result);
}

void cast(const Structure& structure, const Camera& camera, int layers, const CastOptions& options,
          RunResult& result) {
  if (layers == 1) {
    const Stopwatch watch;
    plumb::cast(structure, camera, result.frame, options);
    result.frame_seconds = watch.seconds();
    return;
  }
  LayeredFrame made(camera.width, camera.height, layers);
  const Stopwatch watch;
  cast_layers(structure, camera, made, options);
  result.frame_seconds = watch.seconds();
  take_layers(made, result);
}

}  // namespace

bool has_layers(Method method) { return method != Method::Tile && method != Method::Auto; }

const std::vector<MethodInfo>& all_methods() {
  static const std::vector<MethodInfo> kMethods = {
      {Method::Brute, "brute", "every ray against every triangle; slow", true, false},
      {Method::Bvh2, "bvh2", "rays through the binary tree; scalar", false, true},
      {Method::Bvh4, "bvh4", "rays through the tree of 4 children a node", true, true},
      {Method::Bvh8, "bvh8", "rays through the tree of 8 children a node", true, true},
      {Method::KdTree, "kdtree", "rays through a k-d tree", true, false},
      {Method::Grid, "grid", "rays through a uniform grid", true, false},
      {Method::Octree, "octree", "rays through an adaptive octree", true, false},
      {Method::Spheres, "spheres", "rays through the binary tree with spheres for boxes; scalar", false,
       false},
      {Method::Tile, "tile", "tiles of pixels through the tree of 8 children a node", true, true},
      {Method::Raster, "raster", "the rasterizer", true, true},
      {Method::Auto, "auto", "tile, raster or rays, whichever promises to be fastest for scene and camera",
       true, false},
  };
  return kMethods;
}

std::string_view method_name(Method method) { return info(method).name; }

Method parse_method(std::string_view name) {
  std::string known;
  for (const MethodInfo& candidate : all_methods()) {
    if (candidate.name == name) return candidate.method;
    known.append(known.empty() ? "" : ", ").append(candidate.name);
  }
  throw Error(fmt::format("plumb: unknown method '{}'; known: {}", name, known));
}

std::vector<Method> parse_methods(std::string_view list) {
  std::vector<Method> methods;
  for (const std::string& name : split_list(list)) {
    const Method method = parse_method(name);
    if (std::find(methods.begin(), methods.end(), method) != methods.end()) {
      throw Error(fmt::format("plumb: --methods {}: '{}' is there twice", list, name));
    }
    methods.push_back(method);
  }
  return methods;
}

std::string default_methods() {
  std::string list;
  for (const MethodInfo& candidate : all_methods()) {
    if (candidate.in_default) list.append(list.empty() ? "" : ",").append(candidate.name);
  }
  return list;
}

std::vector<Run> plan_runs(const std::vector<Method>& methods, std::string_view simd) {
  const std::vector<Simd> targets = parse_targets(simd);
  std::vector<Run> runs;
  for (const Method method : methods) {
    const std::string name(method_name(method));
    if (!info(method).has_targets) {
      runs.push_back({method, std::nullopt, name});
      continue;
    }
    for (const Simd target : targets) {
      runs.push_back(
          {method, target, targets.size() == 1 ? name : fmt::format("{}-{}", name, simd_name(target))});
    }
  }
  return runs;
}

Structure build_method(Method method, MeshView mesh, Simd simd, int threads,
                       const std::function<bool(double)>& progress) {
  if (method == Method::Raster) throw Error("plumb: raster casts no rays, so it has no tree");
  StructureSettings all;
  all.simd = simd;
  all.threads = threads;
  all.progress = progress;
  switch (method) {
    case Method::Brute:
      all.kind = StructureKind::BruteForce;
      break;
    case Method::KdTree:
      all.kind = StructureKind::KdTree;
      break;
    case Method::Grid:
      all.kind = StructureKind::UniformGrid;
      break;
    case Method::Octree:
      all.kind = StructureKind::Octree;
      break;
    case Method::Spheres:
      all.kind = StructureKind::SphereTree;
      break;
    case Method::Bvh2:
      all.width = 2;
      break;
    case Method::Bvh4:
      all.width = 4;
      break;
    default:
      all.width = 8;
  }
  return build_structure(mesh, all);
}

RunResult execute(const Run& run, MeshView mesh, const Camera& camera, int threads,
                  const ProgressFor& progress, int layers) {
  if (layers > 1 && !has_layers(run.method))
    throw Error(fmt::format("plumb: {} makes no layers; leave it out", method_name(run.method)));
  RunResult result{Frame(camera.width, camera.height), {}, std::nullopt, 0.0, std::nullopt};
  const Simd simd = run.simd.value_or(Simd::Auto);
  const std::function<bool(double)> frame_progress = progress(run.name + ": frame");
  if (run.method == Method::Raster) {
    draw(mesh, camera, layers, {simd, threads, frame_progress}, result);
    return result;
  }
  const Stopwatch build_watch;
  const Structure structure = build_method(run.method, mesh, simd, threads, progress(run.name + ": build"));
  result.build_seconds = build_watch.seconds();
  if (run.method == Method::Auto) {
    const Stopwatch watch;
    result.choice = visible(mesh, structure, camera, result.frame, {threads, simd, 0, frame_progress});
    result.frame_seconds = watch.seconds();
    return result;
  }
  CastOptions options;
  options.threads = threads;
  options.method = run.method == Method::Tile ? CastMethod::Tiles : CastMethod::Rays;
  options.progress = frame_progress;
  cast(structure, camera, layers, options, result);
  return result;
}

}  // namespace plumb::tool
