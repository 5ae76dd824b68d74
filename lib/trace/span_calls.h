#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/fp_mode.h"
#include "plumb/error.h"
#include "trace/query.h"

// The public query calls, the same for every structure: the floating-point mode kept, sizes checked,
// then the structure's table.

namespace plumb::detail {

inline Hit closest_of_one(const QueryTable& table, const void* structure, const Ray& ray) {
  Hit hit;
  with_default_fp_mode([&] { table.closest(structure, &ray, &hit, 1); });
  return hit;
}

inline bool any_of_one(const QueryTable& table, const void* structure, const Ray& ray) {
  bool hit = false;
  with_default_fp_mode([&] { table.any(structure, &ray, &hit, 1); });
  return hit;
}

inline void all_of_one(const QueryTable& table, const void* structure, const Ray& ray,
                       std::vector<Hit>& hits) {
  with_default_fp_mode([&] { table.all(structure, ray, hits); });
}

inline void check_sizes(std::size_t rays, std::size_t hits) {
  if (rays != hits) {
    throw Error("plumb: " + std::to_string(rays) + " rays but room for " + std::to_string(hits) +
                " answers; give spans of one size");
  }
}

inline void closest_of_span(const QueryTable& table, const void* structure, std::span<const Ray> rays,
                            std::span<Hit> hits) {
  check_sizes(rays.size(), hits.size());
  with_default_fp_mode([&] { table.closest(structure, rays.data(), hits.data(), rays.size()); });
}

inline void any_of_span(const QueryTable& table, const void* structure, std::span<const Ray> rays,
                        std::span<bool> hits) {
  check_sizes(rays.size(), hits.size());
  with_default_fp_mode([&] { table.any(structure, rays.data(), hits.data(), rays.size()); });
}

}  // namespace plumb::detail
