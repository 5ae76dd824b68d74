#include "plumb/brute_force.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "base/fp_mode.h"
#include "base/simd_dispatch.h"
#include "build/mesh_check.h"
#include "exact/intersect.h"
#include "trace/block_list.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

using detail::BlockList;
using detail::Triangle;

float greatest_coordinate(const Triangle& triangle) {
  float greatest = 0.0f;
  for (const glm::vec3& p : {triangle.v0, triangle.v1, triangle.v2})
    greatest = std::max({greatest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return greatest;
}

BlockList finite_triangles(MeshView mesh, std::uint32_t first_id) {
  BlockList list;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    const Triangle triangle{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
    if (!detail::triangle_is_finite(triangle)) continue;
    const std::size_t lane = list.count++ % 8;
    if (lane == 0) list.blocks.emplace_back();
    detail::set_triangle(list.blocks.back(), lane, mesh, static_cast<std::uint32_t>(i), first_id);
    list.greatest = std::max(list.greatest, greatest_coordinate(triangle));
  }
  return list;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const BruteForceOptions& options) {
  detail::check_mesh(mesh, options.first_id, "BruteForce");
  const Simd simd = detail::resolve_simd(options.simd);
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    BlockList list = finite_triangles(mesh, options.first_id);
    Statistics statistics;
    statistics.triangles = mesh.triangles.size();
    statistics.references = list.count;
    statistics.unseen_triangles = statistics.triangles - statistics.references;
    statistics.leaves = 1;
    statistics.depth = 1;
    statistics.leaf_fill =
        list.count == 0 ? 0.0 : list.count / (8.0 * static_cast<double>(list.blocks.size()));
    statistics.sah_cost = list.count;
    statistics.bytes = list.blocks.size() * sizeof(list.blocks[0]);
    data = detail::make_structure_data(std::move(list), detail::block_list_queries, simd);
    data->statistics = statistics;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

BruteForce::BruteForce(MeshView mesh, const BruteForceOptions& options) : Structure(build(mesh, options)) {}

BruteForce::BruteForce(MeshView mesh, std::uint32_t first_id)
    : BruteForce(mesh, BruteForceOptions{Simd::Auto, first_id}) {}

}  // namespace plumb
