#pragma once

#include <doctest/doctest.h>

#include <string>

#include "exact/intersect.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/raster.h"

// What the rasterizer's tests share: the answer by the plainest loop there is.

namespace plumb::raster_test {

/// Every pixel's ray against every triangle, merged into the frame by (t, id).
inline void brute_force_merge(MeshView mesh, const Camera& camera, Frame& frame, std::uint32_t first_id = 0) {
  std::vector<detail::Triangle> triangles;
  for (const glm::uvec3& c : mesh.triangles)
    triangles.push_back({mesh.positions[c.x], mesh.positions[c.y], mesh.positions[c.z]});
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.ray(x, y);
      if (!detail::ray_is_valid(ray)) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
      Hit best{frame.depth[pixel], frame.id[pixel]};
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        float t = 0.0f;
        if (!detail::triangle_is_finite(triangles[i]) ||
            !detail::line_hit(ray.origin, ray.direction, triangles[i], t) || !detail::depth_counts(ray, t))
          continue;
        const std::uint32_t id = first_id + static_cast<std::uint32_t>(i);
        if (detail::hit_before(t, id, best)) best = {t, id};
      }
      frame.depth[pixel] = best.t;
      frame.id[pixel] = best.id;
    }
  }
}

inline Frame brute_force_frame(MeshView mesh, const Camera& camera, std::uint32_t first_id = 0) {
  Frame frame(camera.width, camera.height);
  brute_force_merge(mesh, camera, frame, first_id);
  return frame;
}

inline Frame raster_frame(MeshView mesh, const Camera& camera, const RasterOptions& options = {}) {
  Frame frame(camera.width, camera.height);
  rasterize(mesh, camera, frame, options);
  return frame;
}

/// Holds `frame` to `expected`, bit for bit.
inline void check_frame(const Frame& frame, const Frame& expected) {
  const Comparison comparison = compare(frame, expected);
  std::string difference;
  if (!comparison.equal()) {
    const PixelDifference& p = comparison.first.front();
    difference = std::to_string(comparison.different_pixels) + " pixels, first (" + std::to_string(p.x) +
                 ", " + std::to_string(p.y) + "): " + std::to_string(p.id_a) + " for " +
                 std::to_string(p.id_b);
  }
  INFO(difference);
  CHECK(comparison.equal());
}

}  // namespace plumb::raster_test
