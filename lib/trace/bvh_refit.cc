#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/box.h"
#include "build/mesh_check.h"
#include "build/tree_statistics.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "trace/structure_data.h"
#include "wide/refit.h"
#include "wide/wide_tree.h"

namespace plumb {
namespace {

using detail::StructureData;
using detail::WideTree;

constexpr double kTooLoose = 1.5;

bool is_finite(MeshView mesh, const glm::uvec3& corners) {
  for (int v = 0; v < 3; ++v) {
    const glm::vec3& p = mesh.positions[corners[v]];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  return true;
}

// Throws plumb::Error when a triangle that the tree does not hold is one to see.
template <int W>
void check_unseen(const WideTree<W>& tree, MeshView mesh, std::uint32_t first_id) {
  std::vector<bool> held(mesh.triangles.size());
  for (const detail::WideNode<W>& node : tree.nodes) {
    for (int i = 0; i < W; ++i) {
      for (std::uint32_t k = 0; k < node.count[i]; ++k)
        held[tree.blocks[node.child[i] + k / W].id[k % W] - first_id] = true;
    }
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] || !is_finite(mesh, mesh.triangles[i])) continue;
    throw Error(
        "plumb: Bvh::refit: triangle " + std::to_string(i) +
        " had a NaN or infinite coordinate when the tree was built, and now has none; build a new Bvh");
  }
}

std::size_t count_unseen(MeshView mesh) {
  std::size_t unseen = 0;
  for (const glm::uvec3& corners : mesh.triangles) unseen += is_finite(mesh, corners) ? 0 : 1;
  return unseen;
}

template <int W>
RefitReport refit(std::shared_ptr<const StructureData>& shared, MeshView mesh, int threads) {
  const auto& before = *static_cast<const WideTree<W>*>(shared->structure.get());
  if (shared->statistics.unseen_triangles != 0) check_unseen(before, mesh, shared->refit.first_id);
  const bool alone = shared.use_count() == 1 && shared->structure.use_count() == 1;
  std::shared_ptr<WideTree<W>> tree;
  auto data = std::make_shared<StructureData>(*shared);
  if (data->refit.built_looseness < 0.0) data->refit.built_looseness = tree_areas(before).looseness();
  if (alone) {
    // No one else can see it, and it was made as what is not const.
    tree = std::const_pointer_cast<WideTree<W>>(std::static_pointer_cast<const WideTree<W>>(data->structure));
  } else {
    tree = std::make_shared<WideTree<W>>(before);
    data->structure = tree;
  }
  const detail::TreeAreas areas = detail::refit(*tree, mesh, data->refit.first_id, threads);
  if (areas.unseen != 0 || data->statistics.unseen_triangles != 0)
    data->statistics.unseen_triangles = count_unseen(mesh);
  const double root = detail::half_area(tree->box);
  data->statistics.sah_cost = root > 0.0 ? areas.tests / root : 0.0;
  RefitReport report;
  const double built = data->refit.built_looseness;
  if (built > 0.0 && areas.looseness() > 0.0) report.looseness = areas.looseness() / built;
  report.rebuild_advised = report.looseness > kTooLoose;
  shared = std::move(data);
  return report;
}

}  // namespace

RefitReport Bvh::refit(MeshView mesh, int threads) {
  if (data_->refit.width == 0) {
    throw Error(
        "plumb: Bvh::refit is for trees of width 4 or 8 that are not compact; build a new Bvh instead");
  }
  if (mesh.triangles.size() != data_->statistics.triangles) {
    throw Error("plumb: Bvh::refit: the mesh has " + std::to_string(mesh.triangles.size()) +
                " triangles, the tree was built over " + std::to_string(data_->statistics.triangles) +
                "; build a new Bvh");
  }
  detail::check_mesh(mesh, data_->refit.first_id, "Bvh::refit");
  detail::thread_count(threads);  // throws before anything changes
  RefitReport report;
  detail::with_default_fp_mode([&] {
    report = data_->refit.width == 4 ? plumb::refit<4>(data_, mesh, threads)
                                     : plumb::refit<8>(data_, mesh, threads);
  });
  return report;
}

}  // namespace plumb
