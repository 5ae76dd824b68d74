#include "build/morton_order.h"

#include <algorithm>
#include <array>
#include <utility>

#include "build/chunks.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 32768;
constexpr int kDigitBits = 10;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

// Puts two zeros above each of the lowest ten bits.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

using Histogram = std::array<std::uint32_t, kDigits>;

std::size_t digit(MortonKey key, int shift) { return static_cast<std::size_t>(key >> shift) & (kDigits - 1); }

// One pass of a stable radix sort. Every piece writes its keys of a digit behind those of the pieces before.
void sort_by_digit(const std::vector<MortonKey>& from, std::vector<MortonKey>& to, int shift,
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

BinMap morton_map(Box4 centres, float unit) {
  const Float4 size = centres.hi - centres.lo;
  centres.hi = centres.lo + splat(std::max({size[0], size[1], size[2]}));
  return BinMap(centres, unit, kMortonBins);
}

MortonKey morton_key(const TriangleRef& ref, std::uint32_t item, const BinMap& map) {
  const Int4 bin = map.bin(doubled_centre(ref, map.unit()));
  const std::uint32_t code = spread(static_cast<std::uint32_t>(bin[0])) << 2 |
                             spread(static_cast<std::uint32_t>(bin[1])) << 1 |
                             spread(static_cast<std::uint32_t>(bin[2]));
  return MortonKey{code} << 32 | item;
}

std::vector<MortonKey> morton_order(const TriangleRefs& refs) {
  const std::size_t pieces = piece_count(refs.count, kPieceSize);
  std::vector<Box4> centres(pieces);
  for_pieces(refs.count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 centre = doubled_centre(refs.refs[i], splat(refs.unit));
      centres[piece].add(centre, centre);
    }
  });
  for (std::size_t piece = 1; piece < pieces; ++piece) centres[0].add(centres[piece]);

  std::vector<MortonKey> keys(refs.count), other(refs.count);
  const BinMap map = morton_map(centres[0], refs.unit);
  for_pieces(refs.count, pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = morton_key(refs.refs[i], static_cast<std::uint32_t>(i), map);
  });
  std::vector<Histogram> places(pieces);
  for (int shift = 32; shift < 62; shift += kDigitBits) {
    sort_by_digit(keys, other, shift, places);
    keys.swap(other);
  }
  return keys;
}

}  // namespace plumb::detail
