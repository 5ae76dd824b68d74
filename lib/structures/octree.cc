#include "plumb/octree.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/box.h"
#include "build/mesh_check.h"
#include "plumb/error.h"
#include "structures/octree_build.h"
#include "structures/octree_scene.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

using detail::Box;
using detail::OctreeNode;
using detail::OctreeParts;
using detail::OctreeScene;

constexpr std::size_t kLanes = detail::kOctreeLanes;

// Blocks replace references as what leaves hold.
OctreeScene make_scene(OctreeParts tree, MeshView mesh, const OctreeOptions& options) {
  OctreeScene scene;
  scene.box = tree.box;
  scene.greatest = detail::greatest_coordinate(tree.box);
  scene.nodes = std::move(tree.nodes);
  std::vector<std::uint32_t> leaves;
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].count == OctreeNode::kInner || scene.nodes[i].count == 0) continue;
    leaves.push_back(static_cast<std::uint32_t>(i));
    blocks += (scene.nodes[i].count + kLanes - 1) / kLanes;
  }
  std::vector<std::uint32_t> first(leaves.size());  // in tree.order
  scene.blocks.resize(blocks);
  blocks = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    OctreeNode& leaf = scene.nodes[leaves[i]];
    first[i] = std::exchange(leaf.first, static_cast<std::uint32_t>(blocks));
    blocks += (leaf.count + kLanes - 1) / kLanes;
  }
  constexpr std::size_t kPiece = 1024;  // leaves
  detail::parallel_for((leaves.size() + kPiece - 1) / kPiece, options.threads, [&](std::size_t piece) {
    const std::size_t end = std::min(leaves.size(), (piece + 1) * kPiece);
    for (std::size_t i = piece * kPiece; i < end; ++i) {
      const OctreeNode& leaf = scene.nodes[leaves[i]];
      for (std::uint32_t k = 0; k < leaf.count; ++k) {
        detail::set_triangle(scene.blocks[leaf.first + k / kLanes], k % kLanes, mesh,
                             tree.order[first[i] + k], options.first_id);
      }
    }
  });
  return scene;
}

// Sums over the cells.
Statistics octree_statistics(const OctreeScene& scene) {
  Statistics statistics;
  statistics.width = 8;
  statistics.bytes = scene.nodes.size() * sizeof(OctreeNode) + scene.blocks.size() * sizeof(scene.blocks[0]);
  if (scene.nodes.empty()) return statistics;
  const double root_area = detail::half_area(scene.box);
  struct Cell {
    std::uint32_t node;
    int depth;
    Box box;
  };
  std::vector<Cell> cells{{0, 1, scene.box}};
  std::size_t used = 0;
  while (!cells.empty()) {
    const Cell cell = cells.back();
    cells.pop_back();
    const OctreeNode& node = scene.nodes[cell.node];
    if (node.count == 0) continue;
    ++used;
    const double chance = root_area > 0.0 ? detail::half_area(cell.box) / root_area : 1.0;
    statistics.sah_cost += chance;
    if (node.count != OctreeNode::kInner) {
      ++statistics.leaves;
      statistics.references += node.count;
      statistics.sah_cost += chance * node.count;
      statistics.depth = std::max(statistics.depth, cell.depth);
      continue;
    }
    ++statistics.nodes;
    for (int i = 0; i < 8; ++i) {
      cells.push_back({node.first + static_cast<std::uint32_t>(i), cell.depth + 1,
                       detail::octree_child(cell.box, node.middle, i)});
    }
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  statistics.fill = share(used - 1, 8 * statistics.nodes);  // the root is no child
  statistics.leaf_fill = share(statistics.references, scene.blocks.size() * kLanes);
  return statistics;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const OctreeOptions& options) {
  detail::check_mesh(mesh, options.first_id, "Octree");
  if (mesh.triangles.size() >= std::size_t{1} << 28) {
    throw Error("plumb: Octree: " + std::to_string(mesh.triangles.size()) +
                " triangles; it takes fewer than 2^28");
  }
  const Simd simd = detail::resolve_simd(options.simd);
  detail::thread_count(options.threads);  // throws for one that is none
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    detail::Progress progress(options.progress, mesh.triangles.size());
    OctreeParts tree = detail::build_octree(mesh, progress);
    const std::size_t seen = tree.triangles;
    OctreeScene scene = make_scene(std::move(tree), mesh, options);
    Statistics statistics = octree_statistics(scene);
    statistics.triangles = mesh.triangles.size();
    statistics.unseen_triangles = mesh.triangles.size() - seen;
    data = detail::make_structure_data(std::move(scene), detail::octree_queries, simd);
    data->statistics = statistics;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

Octree::Octree(MeshView mesh, const OctreeOptions& options) : Structure(build(mesh, options)) {}

}  // namespace plumb
