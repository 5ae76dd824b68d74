#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"
#include "plumb/visible.h"

namespace plumb::tool {

/// A way to make a frame.
enum class Method { Brute, Bvh2, Bvh4, Bvh8, KdTree, Grid, Octree, Spheres, Tile, Raster, Auto };

struct MethodInfo {
  Method method;
  std::string_view name;         ///< as `--methods` takes it
  std::string_view description;  ///< one line
  bool has_targets;              ///< compiled for every SIMD target; the others are plain scalar code
  bool in_default;               ///< compared unless `--methods` says otherwise
};
const std::vector<MethodInfo>& all_methods();
std::string_view method_name(Method method);

/// Throws plumb::Error for a name that is none.
Method parse_method(std::string_view name);

/// "bvh4,raster" as methods. Throws plumb::Error for a name that is none and one given twice.
std::vector<Method> parse_methods(std::string_view list);

/// The default of `--methods`, as a list.
std::string default_methods();

/// Whether the method makes layers: all do but Method::Tile and Method::Auto.
bool has_layers(Method method);

/// One method on one SIMD target; a scalar method has none. Its name is the method's, with the
/// target's after it where several targets take part: "bvh4-avx2".
struct Run {
  Method method;
  std::optional<Simd> simd;
  std::string name;
};

/// Every method on every target that `simd` names ("auto", one target, or "all"); scalar methods
/// once. Throws plumb::Error for a target that is none or that this machine cannot run.
std::vector<Run> plan_runs(const std::vector<Method>& methods, std::string_view simd);

/// What rays or tiles are cast through, by a method that casts some: plumb::Error for Method::Raster. `simd`
/// must be usable; scalar methods ignore it.
Structure build_method(Method method, MeshView mesh, Simd simd, int threads,
                       const std::function<bool(double)>& progress);

/// Makes a progress callback for a part of the work, such as "bvh4: build"; may return an empty one.
using ProgressFor = std::function<std::function<bool(double)>(const std::string&)>;

struct RunResult {
  Frame frame;                          ///< of layers, the first
  std::vector<Frame> behind;            ///< the others
  std::optional<double> build_seconds;  ///< of the tree; a method without one has none
  double frame_seconds = 0;
  std::optional<VisibleChoice> choice;  ///< of Method::Auto
};

/// Makes the frame, or as many layers (plumb/layers.h), at least 1. Throws plumb::Error for more than one of
/// a method that has none.
RunResult execute(const Run& run, MeshView mesh, const Camera& camera, int threads,
                  const ProgressFor& progress, int layers = 1);

}  // namespace plumb::tool
