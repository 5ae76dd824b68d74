#include "plumb/bvh.h"

#include <chrono>
#include <string>
#include <utility>
#include <variant>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/binned_sah.h"
#include "build/mesh_check.h"
#include "build/sweep_sah.h"
#include "build/tree_statistics.h"
#include "plumb/error.h"
#include "trace/binary.h"
#include "trace/query.h"
#include "trace/span_calls.h"
#include "trace/wide_kernels.h"
#include "wide/collapse.h"
#include "wide/wide_tree.h"

namespace plumb {

struct Bvh::Impl {
  using Structure = std::variant<detail::BinaryScene, detail::WideTree<4>, detail::WideTree<8>>;

  std::shared_ptr<const Structure> structure;  // shared by the same tree on several instruction sets
  Arithmetic arithmetic = Arithmetic::Exact;
  detail::QueryTable queries{};
  Statistics statistics;

  /// What `queries` take as their structure.
  const void* data() const {
    return std::visit([](const auto& s) { return static_cast<const void*>(&s); }, *structure);
  }
};

namespace {

using detail::BinaryTree;

// What a leaf and a node cost against each other, and how many triangles a test takes at once.
void set_costs(int width, detail::SahOptions& sah) {
  sah.block = width == 2 ? 1 : width;
  sah.max_leaf = width == 2 ? 4 : width;
}

BinaryTree build_binary(MeshView mesh, int width, const BuildOptions& options) {
  detail::Progress progress(options.progress, mesh.triangles.size());
  if (options.quality == Quality::Best) {
    detail::SweepSahOptions sweep;
    set_costs(width, sweep);
    return detail::build_sweep_sah(mesh, sweep, progress);
  }
  detail::BinnedSahOptions binned;
  set_costs(width, binned);
  binned.threads = options.threads;
  if (options.quality == Quality::Fast) binned.bins = 8;
  return detail::build_binned_sah(mesh, binned, progress);
}

Statistics statistics_of(const detail::BinaryScene& scene) {
  Statistics statistics = detail::tree_statistics(scene.tree);
  statistics.bytes +=
      scene.triangles.size() * sizeof(detail::Triangle) + scene.ids.size() * sizeof(std::uint32_t);
  return statistics;
}

template <int W>
Statistics statistics_of(const detail::WideTree<W>& tree) {
  return detail::tree_statistics(tree);
}

detail::QueryTable queries_of(Arithmetic arithmetic, int width, Simd simd) {
  if (width == 2) return detail::binary_queries();
  if (width == 4) return detail::wide4_queries(simd);
  switch (arithmetic) {
    case Arithmetic::Fast:
      return detail::wide8_fast_queries(simd);
    case Arithmetic::Watertight:
      return detail::wide8_watertight_queries(simd);
    default:
      return detail::wide8_queries(simd);
  }
}

Bvh::Impl::Structure make_structure(BinaryTree tree, MeshView mesh, int width, const BuildOptions& options) {
  if (width == 2) return detail::make_binary_scene(std::move(tree), mesh, options.first_id);
  if (width == 4) return detail::collapse<4>(tree, mesh, options.first_id, options.threads);
  return detail::collapse<8>(tree, mesh, options.first_id, options.threads);
}

void build(Bvh::Impl& impl, MeshView mesh, int width, const BuildOptions& options) {
  BinaryTree tree = build_binary(mesh, width, options);
  const std::uint32_t unseen = tree.unseen;
  impl.structure =
      std::make_shared<const Bvh::Impl::Structure>(make_structure(std::move(tree), mesh, width, options));
  impl.statistics = std::visit([](const auto& s) { return statistics_of(s); }, *impl.structure);
  impl.statistics.triangles = mesh.triangles.size();
  impl.statistics.unseen_triangles = unseen;
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
  detail::resolve_simd(options.simd);
  return width;
}

}  // namespace

Bvh::Bvh(MeshView mesh, const BuildOptions& options) {
  detail::check_mesh(mesh, options.first_id, "Bvh");
  const int width = checked_width(options);  // throws before the work, not after
  const auto start = std::chrono::steady_clock::now();
  auto impl = std::make_shared<Impl>();
  detail::with_default_fp_mode([&] { build(*impl, mesh, width, options); });
  impl->arithmetic = options.arithmetic;
  impl->queries = queries_of(options.arithmetic, width, detail::resolve_simd(options.simd));
  impl->statistics.build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  impl_ = std::move(impl);
}

Hit Bvh::closest(const Ray& ray) const { return detail::closest_of_one(impl_->queries, impl_->data(), ray); }
bool Bvh::any(const Ray& ray) const { return detail::any_of_one(impl_->queries, impl_->data(), ray); }
void Bvh::all(const Ray& ray, std::vector<Hit>& hits) const {
  detail::all_of_one(impl_->queries, impl_->data(), ray, hits);
}
void Bvh::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  detail::closest_of_span(impl_->queries, impl_->data(), rays, hits);
}
void Bvh::any(std::span<const Ray> rays, std::span<bool> hits) const {
  detail::any_of_span(impl_->queries, impl_->data(), rays, hits);
}

Bvh Bvh::with_simd(Simd simd) const {
  auto impl = std::make_shared<Impl>(*impl_);
  impl->queries = queries_of(impl_->arithmetic, impl_->statistics.width, detail::resolve_simd(simd));
  Bvh result(*this);
  result.impl_ = std::move(impl);
  return result;
}

Statistics Bvh::statistics() const { return impl_->statistics; }

}  // namespace plumb
