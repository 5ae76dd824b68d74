#include "plumb/sphere_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/binned_sah.h"
#include "build/mesh_check.h"
#include "build/tree_statistics.h"
#include "structures/sphere_ray.h"
#include "trace/binary_traversal.h"
#include "trace/query.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

struct SphereNode {
  detail::Sphere sphere;
  std::uint32_t first, count;  // as BinaryNode's
};

struct SphereScene {
  struct VolumeRay : detail::SphereRay {
    using SphereRay::SphereRay;
    bool meets(const SphereNode& node, float limit, float& near) const {
      return SphereRay::meets(node.sphere, limit, near);
    }
  };

  std::vector<SphereNode> nodes;
  detail::LeafTriangles leaves;
};

detail::QueryTable sphere_queries(Simd) {
  return detail::make_query_table<SphereScene, detail::BinaryTraversal<SphereScene>>();
}

// The tree that Bvh has at width 2.
detail::BinaryTree build_tree(MeshView mesh, const SphereTreeOptions& options) {
  detail::Progress progress(options.progress, mesh.triangles.size());
  detail::BinnedSahOptions binned;
  binned.max_leaf = 4;
  binned.threads = options.threads;
  return detail::build_binned_sah(mesh, binned, progress);
}

// The places in tree.order that each node's triangles have.
struct Range {
  std::uint32_t begin, end;
};

std::vector<Range> node_ranges(const detail::BinaryTree& tree) {
  std::vector<Range> ranges(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {  // children come after their parent
    const detail::BinaryNode& node = tree.nodes[i];
    ranges[i] = node.count != 0 ? Range{node.first, node.first + node.count}
                                : Range{ranges[node.first].begin, ranges[node.first + 1].end};
  }
  return ranges;
}

SphereScene make_scene(const detail::BinaryTree& tree, MeshView mesh, const SphereTreeOptions& options) {
  constexpr std::size_t kPiece = 256;  // nodes
  SphereScene scene;
  scene.leaves = detail::leaf_triangles(tree.order, mesh, options.first_id);
  scene.nodes.resize(tree.nodes.size());
  const std::vector<Range> ranges = node_ranges(tree);
  detail::parallel_for((tree.nodes.size() + kPiece - 1) / kPiece, options.threads, [&](std::size_t piece) {
    const std::size_t end = std::min(tree.nodes.size(), (piece + 1) * kPiece);
    for (std::size_t i = piece * kPiece; i < end; ++i) {
      const std::span<const std::uint32_t> triangles(tree.order.data() + ranges[i].begin,
                                                     ranges[i].end - ranges[i].begin);
      const detail::BinaryNode& node = tree.nodes[i];
      scene.nodes[i] = {detail::bounding_sphere(mesh, triangles, node.box), node.first, node.count};
    }
  });
  return scene;
}

// As tree_statistics() has it for boxes: a line that meets the root's sphere meets another inside with the
// chance of their areas' ratio.
double sah_cost(const std::vector<SphereNode>& nodes) {
  double cost = 0.0;
  for (const SphereNode& node : nodes) {
    const double root = double{nodes[0].sphere.radius};
    const double share = root > 0.0 && std::isfinite(root) ? double{node.sphere.radius} / root : 1.0;
    cost += share * share * (node.count != 0 ? node.count : 2);
  }
  return cost;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const SphereTreeOptions& options) {
  detail::check_mesh(mesh, options.first_id, "SphereTree");
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    const detail::BinaryTree tree = build_tree(mesh, options);
    Statistics statistics = detail::tree_statistics(tree);
    SphereScene scene = make_scene(tree, mesh, options);
    statistics.triangles = mesh.triangles.size();
    statistics.unseen_triangles = tree.unseen;
    statistics.references = mesh.triangles.size() - tree.unseen;
    statistics.sah_cost = sah_cost(scene.nodes);
    statistics.bytes = scene.nodes.size() * sizeof(SphereNode) + detail::bytes_of(scene.leaves);
    data = detail::make_structure_data(std::move(scene), sphere_queries, Simd::Auto);
    data->statistics = statistics;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

SphereTree::SphereTree(MeshView mesh, const SphereTreeOptions& options) : Structure(build(mesh, options)) {}

}  // namespace plumb
