#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "plumb/ray.h"

namespace plumb::tool {

/// How the answers of one answerer compare with the exact ones.
struct Tally {
  std::uint64_t asked = 0;          ///< rays or pixels
  std::uint64_t different = 0;      ///< answers that are not the exact ones, bit for bit
  std::uint64_t wrong_ids = 0;      ///< of these, another id or none: the sum of the next four
  std::uint64_t lost = 0;           ///< nothing where there is something
  std::uint64_t extra = 0;          ///< something where there is nothing
  std::uint64_t other_surface = 0;  ///< a triangle that is not at the exact depth there
  std::uint64_t same_depth = 0;     ///< another triangle at the exact depth
  std::uint64_t other_depths = 0;   ///< where the right surface is seen, a depth that is not the exact one
  std::uint32_t worst_ulps = 0;     ///< of those depths, in steps from float to float

  Tally& operator+=(const Tally& other);
  friend bool operator==(const Tally&, const Tally&) = default;
};

/// The depth, rounded once, at which a ray meets the plane of a triangle; nothing where it does not.
using PlaneDepth = std::function<std::optional<float>(std::uint32_t id)>;

/// Counts one answer. `plane_depth` is asked about the answer's triangle where that is the wrong one.
void count(Tally& tally, const Hit& exact, const Hit& answer, const PlaneDepth& plane_depth);

/// How many floats lie from one to the other, 0 for equal ones; -0 is 0, infinity the float after the
/// greatest, and a NaN as far away as can be.
std::uint32_t ulps_between(float a, float b);

}  // namespace plumb::tool
