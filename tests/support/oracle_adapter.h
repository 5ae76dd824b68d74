#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "oracle/oracle.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

// The library's types as the oracle's, which knows none of them.

namespace plumb::witness {

inline oracle::Vec3 to_oracle(const glm::vec3& v) { return {v.x, v.y, v.z}; }
inline oracle::DVec3 to_oracle(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

inline oracle::Ray to_oracle(const Ray& ray) {
  return {to_oracle(ray.origin), ray.tmin, to_oracle(ray.direction), ray.tmax};
}

inline oracle::Camera to_oracle(const Camera& camera) {
  return {to_oracle(camera.eye), to_oracle(camera.corner),
          to_oracle(camera.du),  to_oracle(camera.dv),
          camera.width,          camera.height};
}

inline std::vector<oracle::Triangle> to_oracle(MeshView mesh, std::uint32_t first_id = 0) {
  std::vector<oracle::Triangle> triangles;
  for (const glm::uvec3& corners : mesh.triangles) {
    const auto id = first_id + static_cast<std::uint32_t>(triangles.size());
    triangles.push_back({to_oracle(mesh.positions[corners.x]), to_oracle(mesh.positions[corners.y]),
                         to_oracle(mesh.positions[corners.z]), id});
  }
  return triangles;
}

inline Hit to_plumb(const oracle::Hit& hit) { return {hit.t, hit.id}; }

inline std::vector<Hit> to_plumb(const std::vector<oracle::Hit>& hits) {
  std::vector<Hit> result;
  for (const oracle::Hit& hit : hits) result.push_back(to_plumb(hit));
  return result;
}

/// The whole frame as the oracle sees it.
inline Frame oracle_frame(MeshView mesh, const Camera& camera) {
  const oracle::Frame seen = oracle::render(oracle::Scene(to_oracle(mesh)), to_oracle(camera));
  Frame frame(camera.width, camera.height);
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    frame.depth[i] = seen.pixels[i].t;
    frame.id[i] = seen.pixels[i].id;
  }
  return frame;
}

}  // namespace plumb::witness
