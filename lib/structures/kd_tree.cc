#include "plumb/kd_tree.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/box.h"
#include "build/mesh_check.h"
#include "structures/kd_build.h"
#include "structures/kd_scene.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

using detail::Box;
using detail::KdNode;
using detail::KdScene;
using detail::KdTreeParts;

constexpr std::size_t kLanes = detail::kKdLanes;

KdScene make_scene(KdTreeParts tree, MeshView mesh, const KdTreeOptions& options) {
  KdScene scene;
  scene.box = tree.box;
  scene.greatest = tree.greatest;
  scene.nodes = std::move(tree.nodes);
  scene.nodes.shrink_to_fit();
  // Blocks replace references as what leaves hold.
  std::vector<std::uint32_t> block_first;  // of each block, in tree.order
  std::vector<std::uint32_t> block_end;
  for (KdNode& node : scene.nodes) {
    if (!node.is_leaf()) continue;
    const std::uint32_t first = node.first(), end = first + node.count();
    node = KdNode::leaf(static_cast<std::uint32_t>(block_first.size()), node.count());
    for (std::uint32_t i = first; i < end; i += kLanes) {
      block_first.push_back(i);
      block_end.push_back(std::min<std::uint32_t>(i + kLanes, end));
    }
  }
  scene.blocks.resize(block_first.size());
  constexpr std::size_t kPiece = 1024;  // blocks
  detail::parallel_for((scene.blocks.size() + kPiece - 1) / kPiece, options.threads, [&](std::size_t piece) {
    const std::size_t end = std::min(scene.blocks.size(), (piece + 1) * kPiece);
    for (std::size_t b = piece * kPiece; b < end; ++b) {
      for (std::uint32_t i = block_first[b]; i < block_end[b]; ++i)
        detail::set_triangle(scene.blocks[b], i - block_first[b], mesh, tree.order[i], options.first_id);
    }
  });
  return scene;
}

// Sums over the cells, whose boxes follow from the planes above them.
Statistics kd_statistics(const KdScene& scene) {
  Statistics statistics;
  statistics.width = 2;
  statistics.bytes = scene.nodes.size() * sizeof(KdNode) + scene.blocks.size() * sizeof(scene.blocks[0]);
  if (scene.nodes.empty()) return statistics;
  const double root_area = detail::half_area(scene.box);
  struct Cell {
    Box box;
    int depth;
  };
  std::vector<Cell> above{{scene.box, 1}};  // cells whose nodes come next, the last first
  for (const KdNode& node : scene.nodes) {
    const Cell cell = above.back();
    above.pop_back();
    const double chance = root_area > 0.0 ? detail::half_area(cell.box) / root_area : 1.0;
    statistics.sah_cost += chance;
    if (node.is_leaf()) {
      if (node.count() == 0) continue;
      ++statistics.leaves;
      statistics.references += node.count();
      statistics.sah_cost += chance * node.count();
      statistics.depth = std::max(statistics.depth, cell.depth);
      continue;
    }
    ++statistics.nodes;
    Cell upper = cell, lower = cell;
    upper.box.lo[node.axis()] = lower.box.hi[node.axis()] = node.plane();
    upper.depth = lower.depth = cell.depth + 1;
    above.push_back(upper);
    above.push_back(lower);
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  // Every cell but the root and the empty ones is a used child.
  statistics.fill = share(statistics.nodes + statistics.leaves - 1, 2 * statistics.nodes);
  statistics.leaf_fill = share(statistics.references, scene.blocks.size() * kLanes);
  return statistics;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const KdTreeOptions& options) {
  detail::check_mesh(mesh, options.first_id, "KdTree");
  const Simd simd = detail::resolve_simd(options.simd);
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    detail::Progress progress(options.progress, mesh.triangles.size());
    detail::KdBuildOptions build_options;
    build_options.threads = options.threads;
    KdTreeParts tree = detail::build_kd_tree(mesh, build_options, progress);
    const std::size_t unseen = tree.unseen;
    KdScene scene = make_scene(std::move(tree), mesh, options);
    const Statistics statistics = kd_statistics(scene);
    data = detail::make_structure_data(std::move(scene), detail::kd_queries, simd);
    data->statistics = statistics;
    data->statistics.triangles = mesh.triangles.size();
    data->statistics.unseen_triangles = unseen;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

KdTree::KdTree(MeshView mesh, const KdTreeOptions& options) : Structure(build(mesh, options)) {}

}  // namespace plumb
