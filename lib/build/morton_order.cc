#include "build/morton_order.h"

#include <array>
#include <utility>
#include <vector>

#include "build/chunks.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 32768;
constexpr int kDigitBits = 10;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

using Histogram = std::array<std::uint32_t, kDigits>;

std::size_t digit(MortonKey key, int shift) { return static_cast<std::size_t>(key >> shift) & (kDigits - 1); }

// One pass of a stable radix sort. Every piece writes its keys of a digit behind those of the pieces before.
void sort_by_digit(const UnsetVector<MortonKey>& from, UnsetVector<MortonKey>& to, int shift,
                   std::vector<Histogram>& places) {
  for_pieces(from.size(), places.size(), [&](std::size_t piece, std::size_t begin, std::size_t end) {
    places[piece].fill(0);
    for (std::size_t i = begin; i < end; ++i) ++places[piece][digit(from[i], shift)];
  });
  std::uint32_t place = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    for (Histogram& histogram : places) place += std::exchange(histogram[d], place);
  }
  for_pieces(from.size(), places.size(), [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[places[piece][digit(from[i], shift)]++] = from[i];
  });
}

}  // namespace

MortonMap::MortonMap(const Box4& centres, float unit)
    : unit_(splat(unit)), origin_(centres.lo), scale_(splat(0.0f)), spread_{} {
  float size[3];
  for (int axis = 0; axis < 3; ++axis) size[axis] = centres.hi[axis] - centres.lo[axis];
  int bits[3] = {0, 0, 0};
  int place[3][kAxisBits];  // of an axis' bits, the highest first
  for (int bit = kMortonBits - 1; bit >= 0; --bit) {
    int longest = -1;
    for (int axis = 0; axis < 3; ++axis) {
      if (bits[axis] < kAxisBits && (longest < 0 || size[axis] > size[longest])) longest = axis;
    }
    place[longest][bits[longest]++] = bit;
    size[longest] *= 0.5f;
  }
  for (int axis = 0; axis < 3; ++axis) {
    // A little less than cells / extent, so that the greatest centre, whatever rounding does, still falls
    // into the last cell. 0 on an axis where the centres lie too close: all fall into cell 0.
    const float extent = centres.hi[axis] - centres.lo[axis];
    const float factor = static_cast<float>(1 << bits[axis]) * (1.0f - 0x1p-20f);
    if (extent >= 0x1p-105f) scale_[axis] = factor / extent;
    for (int bit = 0; bit < bits[axis]; ++bit) {
      const std::uint32_t code = 1u << place[axis][bits[axis] - 1 - bit];
      for (std::uint32_t i = 0; i < 256; ++i)
        if ((i >> (bit % 8) & 1) != 0) spread_[axis][bit / 8][i] |= code;
    }
  }
}

UnsetVector<MortonKey> morton_order(const TriangleRefs& refs) {
  const std::size_t pieces = piece_count(refs.count, kPieceSize);
  std::vector<Box4> centres(pieces);
  for_pieces(refs.count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 centre = doubled_centre(refs.refs[i], splat(refs.unit));
      centres[piece].add(centre, centre);
    }
  });
  for (std::size_t piece = 1; piece < pieces; ++piece) centres[0].add(centres[piece]);

  UnsetVector<MortonKey> keys(refs.count), other(refs.count);
  const MortonMap map(centres[0], refs.unit);
  for_pieces(refs.count, pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) keys[i] = map.key(refs.refs[i], static_cast<std::uint32_t>(i));
  });
  std::vector<Histogram> places(pieces);
  for (int shift = 32; shift < 32 + kMortonBits; shift += kDigitBits) {
    sort_by_digit(keys, other, shift, places);
    keys.swap(other);
  }
  return keys;
}

}  // namespace plumb::detail
