#include "plumb/bvh.h"

#include <memory>
#include <string>
#include <utility>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/binned_sah.h"
#include "build/clustered_sah.h"
#include "build/mesh_check.h"
#include "build/reinsertion.h"
#include "build/tree_statistics.h"
#include "plumb/error.h"
#include "tiles/tile_kernel.h"
#include "trace/binary.h"
#include "trace/query.h"
#include "trace/structure_data.h"
#include "trace/wide_kernels.h"
#include "wide/collapse.h"
#include "wide/compact_tree.h"
#include "wide/wide_tree.h"

namespace plumb {

namespace {

using detail::BinaryTree;

// What a leaf and a node cost against each other, and how many triangles a test takes at once.
void set_costs(int width, detail::SahOptions& sah) {
  sah.block = width == 2 ? 1 : width;
  sah.max_leaf = width == 2 ? 4 : width;
}

BinaryTree build_binary(MeshView mesh, int width, const BuildOptions& options) {
  if (options.quality == Quality::Fast) {
    detail::Progress progress(options.progress, mesh.triangles.size());
    detail::ClusteredSahOptions clustered;
    set_costs(width, clustered);
    clustered.threads = options.threads;
    return detail::build_clustered_sah(mesh, clustered, progress);
  }
  detail::BinnedSahOptions binned;
  set_costs(width, binned);
  binned.threads = options.threads;
  if (options.quality == Quality::Best) binned.duplicates = 0.5f;
  const std::size_t improving = mesh.triangles.size() / 8;  // its steps, by the time that it takes
  detail::Progress progress(options.progress, mesh.triangles.size() + improving);
  BinaryTree tree = detail::build_binned_sah(mesh, binned, progress);
  detail::reinsert(tree, {}, progress, improving);
  progress.throw_if_cancelled();
  return tree;
}

using QueriesFor = detail::QueryTable (*)(Simd);
using TilesFor = detail::TileCaster (*)(Simd);

QueriesFor wide8_queries_for(Arithmetic arithmetic) {
  switch (arithmetic) {
    case Arithmetic::Fast:
      return detail::wide8_fast_queries;
    case Arithmetic::Watertight:
      return detail::wide8_watertight_queries;
    default:
      return detail::wide8_queries;
  }
}

template <int W>
std::shared_ptr<detail::StructureData> make_wide(const BinaryTree& tree, MeshView mesh,
                                                 const BuildOptions& options, QueriesFor queries_for,
                                                 TilesFor tiles_for) {
  detail::WideTree<W> wide = detail::collapse<W>(tree, mesh, options.first_id, options.threads);
  const Statistics statistics = detail::tree_statistics(wide);
  const std::size_t blocks = wide.blocks.size();
  auto data = detail::make_structure_data(std::move(wide), queries_for, detail::resolve_simd(options.simd));
  data->statistics = statistics;
  data->refit = {W, options.first_id};
  // The tiles' triangles are numbered by 32 bits.
  if (blocks < 0xffffffffu / W) data->tiles_for = tiles_for;
  return data;
}

std::shared_ptr<detail::StructureData> make_compact(const BinaryTree& tree, MeshView mesh,
                                                    const BuildOptions& options) {
  detail::WideTree<8> wide = detail::collapse<8>(tree, mesh, options.first_id, options.threads);
  Statistics statistics = detail::tree_statistics(wide);
  detail::CompactTree<8> compact = detail::compact<8>(std::move(wide), options.threads);
  statistics.bytes = compact.nodes.capacity() * sizeof(compact.nodes[0]) +
                     compact.units.capacity() * sizeof(compact.units[0]);
  auto data = detail::make_structure_data(std::move(compact), detail::wide8_compact_queries,
                                          detail::resolve_simd(options.simd));
  data->statistics = statistics;
  return data;
}

std::shared_ptr<detail::StructureData> make_binary(BinaryTree tree, MeshView mesh,
                                                   const BuildOptions& options) {
  Statistics statistics = detail::tree_statistics(tree);
  detail::BinaryScene scene = detail::make_binary_scene(std::move(tree), mesh, options.first_id);
  statistics.bytes = scene.nodes.size() * sizeof(scene.nodes[0]) + detail::bytes_of(scene.leaves);
  auto data = detail::make_structure_data(std::move(scene), detail::binary_queries, Simd::Auto);
  data->statistics = statistics;
  return data;
}

std::shared_ptr<detail::StructureData> make_data(BinaryTree tree, MeshView mesh, int width,
                                                 const BuildOptions& options) {
  if (width == 2) return make_binary(std::move(tree), mesh, options);
  if (options.compact) return make_compact(tree, mesh, options);
  if (width == 4) return make_wide<4>(tree, mesh, options, detail::wide4_queries, detail::wide4_tile_caster);
  const bool exact = options.arithmetic == Arithmetic::Exact;
  return make_wide<8>(tree, mesh, options, wide8_queries_for(options.arithmetic),
                      exact ? detail::wide8_tile_caster : nullptr);
}

// Throws plumb::Error unless the enumerator, whose values go from 0 to `last`, is one.
template <typename Enum>
void check_enumerator(Enum value, Enum last, const char* name) {
  if (value >= Enum{} && value <= last) return;
  throw Error("plumb: BuildOptions::" + std::string(name) + " is " + std::to_string(static_cast<int>(value)) +
              ", which is none of its enumerators");
}

// The width, or plumb::Error for options out of range.
int checked_width(const BuildOptions& options) {
  check_enumerator(options.quality, Quality::Best, "quality");
  check_enumerator(options.arithmetic, Arithmetic::Exact, "arithmetic");
  // Eight children are faster than four on AVX2 and AVX-512; without vector instructions four are.
  const int width = options.width == 0 ? 8 : options.width;
  if (width != 2 && width != 4 && width != 8) {
    throw Error("plumb: BuildOptions::width is " + std::to_string(width) + "; it must be 0, 2, 4 or 8");
  }
  if (width != 8 && options.arithmetic != Arithmetic::Exact) {
    throw Error("plumb: BuildOptions::width is " + std::to_string(width) +
                "; for Arithmetic::Fast and Arithmetic::Watertight it must be 0 or 8");
  }
  if (options.compact && (width != 8 || options.arithmetic != Arithmetic::Exact)) {
    throw Error(
        "plumb: BuildOptions::compact is for width 0 or 8 and Arithmetic::Exact; leave one of them out");
  }
  detail::resolve_simd(options.simd);
  return width;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const BuildOptions& options) {
  detail::check_mesh(mesh, options.first_id, "Bvh");
  const int width = checked_width(options);  // throws before the work, not after
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    BinaryTree tree = build_binary(mesh, width, options);
    const std::uint32_t unseen = tree.unseen;
    const std::size_t references = tree.order.size();
    data = make_data(std::move(tree), mesh, width, options);
    data->statistics.triangles = mesh.triangles.size();
    data->statistics.unseen_triangles = unseen;
    data->statistics.references = references;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

Bvh::Bvh(MeshView mesh, const BuildOptions& options) : Structure(build(mesh, options)) {}

}  // namespace plumb
