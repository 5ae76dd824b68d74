// A ray against the W boxes of a node at once (Wald, Benthin and Boulos 2008, "Getting Rid of Packets"),
// for every arithmetic: which boxes a test keeps follows from the ray's origins and inverses alone.
// Included once per Highway target.

#if defined(PLUMB_TRACE_BOX_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_BOX_TEST_INL_H_
#undef PLUMB_TRACE_BOX_TEST_INL_H_
#else
#define PLUMB_TRACE_BOX_TEST_INL_H_
#endif

#include <cstdint>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The children that the ray may meet no farther than `limit`, one bit each, and their near values.
// `SlabRay` is BoxRay, FastRay or WatertightRay.
template <int W, class SlabRay>
HWY_INLINE std::uint32_t TestBoxes(const WideNode<W>& node, const SlabRay& ray, float limit, float* near) {
  const hn::CappedTag<float, W> d;
  using V = hn::Vec<decltype(d)>;
  std::uint32_t met = 0;
  for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
    V nearest = hn::Set(d, ray.tmin);
    V farthest = hn::Set(d, limit);
    for (int axis = 0; axis < 3; ++axis) {
      const V near_plane = hn::Load(d, node.bounds[ray.near_row[axis]] + lane);
      const V far_plane = hn::Load(d, node.bounds[ray.far_row[axis]] + lane);
      const V to_near = hn::Sub(near_plane, hn::Set(d, ray.near_origin(axis)));
      const V to_far = hn::Sub(far_plane, hn::Set(d, ray.far_origin(axis)));
      nearest = hn::Max(nearest, hn::Mul(to_near, hn::Set(d, ray.near_inverse(axis))));
      farthest = hn::Min(farthest, hn::Mul(to_far, hn::Set(d, ray.far_inverse(axis))));
    }
    hn::Store(nearest, d, near + lane);
    if constexpr (SlabRay::kUnderflow != 0.0f) nearest = hn::Sub(nearest, hn::Set(d, SlabRay::kUnderflow));
    met |= MaskBits(d, hn::Le(nearest, farthest)) << lane;
  }
  return met;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
