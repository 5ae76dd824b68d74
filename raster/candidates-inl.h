// Which of a mesh's triangles may be seen. Included once per Highway target.

#if defined(PLUMB_RASTER_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_CANDIDATES_INL_H_
#undef PLUMB_RASTER_CANDIDATES_INL_H_
#else
#define PLUMB_RASTER_CANDIDATES_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include "hwy/highway.h"
#include "pixels/projection.h"
#include "pixels/screen_bounds-inl.h"
#include "plumb/mesh.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Corners of one vector of triangles, as floats; lanes beyond the mesh are NaN.
struct FetchedCorners {
  alignas(64) float corner[9][8];
};

HWY_INLINE void FetchCorners(MeshView mesh, size_t first, size_t count, FetchedCorners& to) {
  for (size_t lane = 0; lane < count; ++lane) {
    const glm::uvec3& c = mesh.triangles[first + lane];
    const glm::vec3* const vertex[3] = {&mesh.positions[c.x], &mesh.positions[c.y], &mesh.positions[c.z]};
    for (int v = 0; v < 3; ++v) {
      to.corner[3 * v][lane] = vertex[v]->x;
      to.corner[3 * v + 1][lane] = vertex[v]->y;
      to.corner[3 * v + 2][lane] = vertex[v]->z;
    }
  }
  for (size_t lane = count; lane < hn::Lanes(SetupTag()); ++lane)
    to.corner[0][lane] = std::numeric_limits<float>::quiet_NaN();
}

// Where the screen says nothing: every finite triangle may be anywhere in the frame.
HWY_INLINE std::uint32_t BoundNowhere(const Projection& view, const float* const corner[9],
                                      ScreenBoxes& boxes) {
  const hn::Rebind<float, SetupTag> df;
  auto total = hn::Zero(df);
  for (int k = 0; k < 9; ++k) total = hn::MulAdd(hn::Load(df, corner[k]), hn::Zero(df), total);
  for (int lane = 0; lane < 8; ++lane) {
    boxes.x0[lane] = boxes.y0[lane] = 0;
    boxes.x1[lane] = view.width - 1;
    boxes.y1[lane] = view.height - 1;
    boxes.nearest[lane] = std::numeric_limits<float>::infinity();
  }
  return MaskBits(df, hn::Eq(total, hn::Zero(df)));
}

// Candidates among the mesh's triangles from `first` to before `last`, at most kSetupGroup.
inline void FindCandidates(const Projection& view, MeshView mesh, size_t first, size_t last,
                           SetupCandidates& to) {
  const bool bounded = view.slack_px < kDoubleInfinity;
  const size_t lanes = hn::Lanes(SetupTag());
  FetchedCorners fetched{};
  const float* corner[9];
  for (int k = 0; k < 9; ++k) corner[k] = fetched.corner[k];
  ScreenBoxes boxes;
  to.count = 0;
  for (size_t i = first; i < last; i += lanes) {
    FetchCorners(mesh, i, last - i < lanes ? last - i : lanes, fetched);
    const std::uint32_t seen =
        bounded ? BoundOnScreen(view, WholeFrame(view), corner, boxes) : BoundNowhere(view, corner, boxes);
    AddCandidates(corner, boxes, seen, i, to);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
