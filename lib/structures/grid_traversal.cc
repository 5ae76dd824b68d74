// Rays through a uniform grid, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "structures/grid_traversal.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "structures/grid_ray.h"
#include "structures/grid_scene.h"
#include "trace/exact_tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

inline constexpr std::uint32_t kGridLanes = 8;

// The triangles that a step of the walk comes upon, tested eight at a time. One that was among the last few
// is not taken again (mailboxes that the ray brings along: Benthin 2006, "Realtime Ray Tracing on Current CPU
// Architectures").
class GridCandidates {
 public:
  explicit GridCandidates(const GridScene& scene) : scene_(scene) {
    for (std::uint32_t& box : recent_) box = kNone;
  }

  // True when the query is done.
  template <class Query>
  HWY_INLINE bool add(std::uint32_t ref, ExactTests<kGridLanes>& tests, Query& query) {
    std::uint32_t& box = recent_[ref % kBoxes];
    if (box == ref) return false;
    box = ref;
    const GridTriangle& t = scene_.triangles[ref];
    for (int k = 0; k < 9; ++k) block_.vertex[k / 3][k % 3][count_] = t.corner[k];
    block_.extent[count_] = t.extent;
    block_.id[count_] = t.id;
    return ++count_ == kGridLanes && flush(tests, query);
  }

  template <class Query>
  HWY_INLINE bool flush(ExactTests<kGridLanes>& tests, Query& query) {
    if (count_ == 0) return false;
    query.count_triangles(count_);
    const bool done = tests.leaf(&block_, count_, query);
    query.keep_waiting();  // the block is filled anew
    count_ = 0;
    return done;
  }

 private:
  static constexpr std::uint32_t kBoxes = 16;

  const GridScene& scene_;
  std::uint32_t recent_[kBoxes];
  std::uint32_t count_ = 0;
  TriangleBlock<kGridLanes> block_{};
};

// Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing", made sure of: one step is a
// slab of cells across the axis whose planes the ray meets most often, and takes all cells of the slab that
// the ray may come through (structures/grid_ray.h), mostly one or two. So no rounding and no crossing of
// planes at nearly one t can lose a cell.
struct GridTraversal {
  template <class Query>
  static void run(const GridScene& scene, const Ray& ray, Query& query) {
    if (scene.triangles.empty()) return;
    const GridRay walk(ray, scene);
    GridSpan span;
    if (!walk.begin(query.limit(), span)) return;
    ExactTests<kGridLanes> tests(scene.greatest, ray, query.limit());
    GridCandidates candidates(scene);
    for (int slab = span.first; slab != span.end; slab += span.step) {
      GridCells cells;
      const GridWalk state = walk.slab(slab, query.limit(), cells);
      if (state == GridWalk::kBeyond) break;
      if (state == GridWalk::kOutside) continue;
      for (int z = cells.lo[2]; z <= cells.hi[2]; ++z) {
        for (int y = cells.lo[1]; y <= cells.hi[1]; ++y) {
          for (int x = cells.lo[0]; x <= cells.hi[0]; ++x) {
            query.count_volumes(1);
            const std::size_t cell = scene.cell(x, y, z);
            for (std::uint32_t i = scene.start[cell]; i < scene.start[cell + 1]; ++i) {
              if (candidates.add(scene.refs[i], tests, query)) return;
            }
          }
        }
      }
      if (candidates.flush(tests, query)) return;
    }
  }
};

QueryTable GridQueries() { return make_query_table<GridScene, GridTraversal>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(GridQueries);

QueryTable grid_queries(Simd simd) { return PLUMB_DISPATCH(GridQueries, simd)(); }

}  // namespace plumb::detail
#endif
