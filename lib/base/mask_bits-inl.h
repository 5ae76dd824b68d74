// A mask's lanes as bits of a word. Included once per Highway target.

#if defined(PLUMB_BASE_MASK_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_BASE_MASK_BITS_INL_H_
#undef PLUMB_BASE_MASK_BITS_INL_H_
#else
#define PLUMB_BASE_MASK_BITS_INL_H_
#endif

#include <bit>
#include <cstdint>
#include <cstring>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Lane 0 in bit 0; at most 16 lanes. (Highway 1.0.3 has no general BitsFromMask.)
template <class D>
HWY_INLINE std::uint32_t MaskBits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};  // Highway may store up to 8
  hn::StoreMaskBits(d, mask, bytes);
  if constexpr (std::endian::native == std::endian::little) {
    std::uint16_t word;  // in one step: compilers do not see through two
    std::memcpy(&word, bytes, sizeof word);
    return word;
  }
  return bytes[0] | (std::uint32_t{bytes[1]} << 8);
}

// The inverse; bits beyond the lanes are ignored.
template <class D>
HWY_INLINE hn::Mask<D> MaskOfBits(D d, std::uint32_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(d, bytes);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
