#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "build/sah_bins.h"
#include "build/triangle_refs.h"

// Morton 1966, "A computer oriented geodetic data base and a new technique in file sequencing": places in the
// order of a curve that fills space, so that neighbours in the order are neighbours in space.

namespace plumb::detail {

/// A triangle's place on the curve in the upper half, its index into the TriangleRefs in the lower.
using MortonKey = std::uint64_t;

inline std::uint32_t morton_code(MortonKey key) { return static_cast<std::uint32_t>(key >> 32); }
inline std::uint32_t morton_item(MortonKey key) { return static_cast<std::uint32_t>(key); }

/// Bins per axis of a map for morton_key.
inline constexpr int kMortonBins = 1024;

/// A map for morton_key of triangles whose doubled centres lie in the box. Its bins are cubes: with bins as
/// flat as a terrain the curve would sort by height as soon as by place.
BinMap morton_map(Box4 centres, float unit);

/// The key by the bins of a triangle's centre.
MortonKey morton_key(const TriangleRef& ref, std::uint32_t item, const BinMap& map);

/// The keys of all triangles, sorted. Call it in an arena.
std::vector<MortonKey> morton_order(const TriangleRefs& refs);

}  // namespace plumb::detail
