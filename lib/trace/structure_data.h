#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "plumb/simd.h"
#include "plumb/statistics.h"
#include "tiles/tile_kernel.h"
#include "trace/query.h"

namespace plumb::detail {

/// What following moved vertices takes; `width` is 0 where that is not possible.
struct RefitData {
  int width = 0;
  std::uint32_t first_id = 0;
  double built_looseness = -1.0;  ///< of the tree as it was built; negative while no one has asked
};

/// What a Structure holds. Copies of a Structure share it; the same structure on several instruction sets
/// shares `structure`.
struct StructureData {
  std::shared_ptr<const void> structure;  ///< what the queries take
  QueryTable (*queries_for)(Simd);        ///< for a resolved target; scalar code ignores it
  QueryTable queries;
  TileCaster (*tiles_for)(Simd) = nullptr;  ///< for a resolved target; null where only rays are cast
  Simd simd = Simd::Auto;                   ///< the resolved target of `queries`
  Statistics statistics;
  RefitData refit;
};

/// `simd` must have been resolved.
template <typename Made>
std::shared_ptr<StructureData> make_structure_data(Made structure, QueryTable (*queries_for)(Simd),
                                                   Simd simd) {
  auto data = std::make_shared<StructureData>();
  data->structure = std::make_shared<const Made>(std::move(structure));
  data->queries_for = queries_for;
  data->queries = queries_for(simd);
  data->simd = simd;
  return data;
}

/// For Statistics::build_seconds.
class BuildClock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace plumb::detail
