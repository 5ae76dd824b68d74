#include "plumb/visible.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/fp_mode.h"
#include "frame/frame_check.h"
#include "pixels/projection.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/raster.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

// Triangles looked at.
constexpr std::size_t kSample = 1024;

// Where more than this share of the triangles lies in the frame, and more than so many of them to a pixel,
// tiles would walk nearly all of the tree for triangles that are small: drawing them as they come is faster.
constexpr double kInView = 0.9;
constexpr double kPerPixel = 0.1;

// Below so many triangles to a pixel there are a few to a tile, and less than a tree to walk for it.
constexpr double kFewPerPixel = 1.0 / 400.0;

// Where more than so many triangles in view come to a pixel, a ray for each meets few of them.
constexpr double kManyPerPixel = 2.5;

// A ray takes about as long as rasterizing two triangles.
constexpr double kTrianglesARay = 2.0;

double dot(const detail::Vector3& row, const glm::dvec3& p) {
  return row.x * p.x + row.y * p.y + row.z * p.z;
}

// Whether the triangle's centroid lies in the frame.
bool in_frame(const detail::Projection& view, MeshView mesh, std::size_t index) {
  const glm::uvec3& c = mesh.triangles[index];
  for (int v = 0; v < 3; ++v) {
    if (c[v] >= mesh.positions.size()) {
      throw Error("plumb: triangle " + std::to_string(index) + " has vertex " + std::to_string(c[v]) +
                  ", but there are " + std::to_string(mesh.positions.size()) + " vertices");
    }
  }
  const glm::dvec3 sum =
      glm::dvec3(mesh.positions[c.x]) + glm::dvec3(mesh.positions[c.y]) + glm::dvec3(mesh.positions[c.z]);
  const glm::dvec3 p = sum / 3.0 - glm::dvec3(view.eye.x, view.eye.y, view.eye.z);
  const double depth = dot(view.row_z, p), x = dot(view.row_x, p), y = dot(view.row_y, p);
  return depth > 0.0 && x >= -0.5 * depth && x < (view.width - 0.5) * depth && y >= -0.5 * depth &&
         y < (view.height - 0.5) * depth;
}

// The share of the triangles in the frame, from a sample.
double share_in_frame(MeshView mesh, const Camera& camera) {
  return detail::with_default_fp_mode([&] {
    const detail::Projection view(camera);
    const std::size_t count = mesh.triangles.size();
    const std::size_t step = std::max<std::size_t>((count + kSample - 1) / kSample, 1);
    std::size_t asked = 0, inside = 0;
    for (std::size_t i = 0; i < count; i += step) {
      ++asked;
      inside += in_frame(view, mesh, i) ? 1 : 0;
    }
    return asked == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(asked);
  });
}

}  // namespace

const char* visible_method_name(VisibleMethod method) {
  switch (method) {
    case VisibleMethod::Raster:
      return "raster";
    case VisibleMethod::Tiles:
      return "tiles";
    default:
      return "rays";
  }
}

VisibleChoice choose_visible(MeshView mesh, const Structure* structure, const Camera& camera) {
  detail::check_camera(camera);
  if (structure == nullptr)
    return {VisibleMethod::Raster, "without a tree the triangles are drawn as they come"};
  const std::size_t count = mesh.triangles.size();
  const std::size_t known = structure->statistics().triangles;
  if (known != count) {
    throw Error("plumb: visible(): the mesh has " + std::to_string(count) + " triangles, the structure " +
                std::to_string(known) + "; hand over the one built for this mesh");
  }
  const double triangles = static_cast<double>(count);
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const double share = share_in_frame(mesh, camera);
  if (structure->data().tiles_for == nullptr) {
    if (triangles > kTrianglesARay * pixels)
      return {VisibleMethod::Rays, "a ray for each pixel takes less than drawing so many triangles"};
    return {VisibleMethod::Raster, "the structure casts rays only, and drawing so few triangles takes less"};
  }
  if (triangles < kFewPerPixel * pixels)
    return {VisibleMethod::Raster, "so few triangles are listed sooner than a tree is walked"};
  if (share * triangles > kManyPerPixel * pixels)
    return {VisibleMethod::Rays,
            "several triangles in view come to each pixel, and its ray meets few of them"};
  if (share > kInView && share * triangles > kPerPixel * pixels)
    return {VisibleMethod::Raster,
            "nearly all triangles are in view and small, so a tree would be walked for nothing"};
  return {VisibleMethod::Tiles, "a tree spares what lies outside the view or is hidden"};
}

VisibleChoice visible(MeshView mesh, const Camera& camera, Frame& frame, const VisibleOptions& options) {
  RasterOptions raster;
  raster.threads = options.threads;
  raster.simd = options.simd;
  raster.first_id = options.first_id;
  raster.progress = options.progress;
  raster.overwrite = true;
  VisibleChoice choice = choose_visible(mesh, nullptr, camera);
  rasterize(mesh, camera, frame, raster);
  return choice;
}

VisibleChoice visible(MeshView mesh, const Structure& structure, const Camera& camera, Frame& frame,
                      const VisibleOptions& options) {
  VisibleChoice choice = choose_visible(mesh, &structure, camera);
  if (choice.method == VisibleMethod::Raster) {
    visible(mesh, camera, frame, options);
    return choice;
  }
  CastOptions cast_options;
  cast_options.threads = options.threads;
  cast_options.simd = options.simd;
  cast_options.progress = options.progress;
  cast_options.method = choice.method == VisibleMethod::Tiles ? CastMethod::Tiles : CastMethod::Rays;
  cast(structure, camera, frame, cast_options);
  return choice;
}

}  // namespace plumb
