#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "cases/cases.h"
#include "oracle/oracle.h"
#include "support/effort.h"
#include "support/exact_facts.h"
#include "support/oracle_adapter.h"

// How large a share of a case's instances, rays, pixels or triangles has a property.

namespace plumb::cases {

inline constexpr std::uint64_t kTestSeed = 1;

struct Share {
  std::size_t having = 0, of = 0;
  void count(bool has) {
    having += has ? 1 : 0;
    ++of;
  }
  double value() const { return of == 0 ? 0.0 : static_cast<double>(having) / static_cast<double>(of); }
};

/// Calls `visit(instance)` for the first instances of a case.
template <typename Visit>
void each_instance(std::string_view name, std::uint64_t count, const Visit& visit) {
  for (std::uint64_t i = 0; i < hard::effort(count); ++i)
    visit(make_instance(*find_case(name), kTestSeed, i));
}

/// Of the rays: `has(instance, ray)`.
template <typename Has>
double ray_share(std::string_view name, const Has& has) {
  Share share;
  each_instance(name, 100, [&](const Instance& instance) {
    for (const Ray& ray : instance.rays) share.count(has(instance, ray));
  });
  return share.value();
}

/// Of the pixels: `has(instance, ray)`, with the pixel's ray.
template <typename Has>
double pixel_share(std::string_view name, const Has& has) {
  Share share;
  each_instance(name, 8, [&](const Instance& instance) {
    for (const Ray& ray : pixel_rays(instance)) share.count(has(instance, ray));
  });
  return share.value();
}

/// Of the instances: `has(instance)`.
template <typename Has>
double instance_share(std::string_view name, const Has& has) {
  Share share;
  each_instance(name, 100, [&](const Instance& instance) { share.count(has(instance)); });
  return share.value();
}

/// Of the triangles: `has(v0, v1, v2)`.
template <typename Has>
double triangle_share(std::string_view name, const Has& has) {
  Share share;
  each_instance(name, 100, [&](const Instance& instance) {
    const std::vector<glm::vec3>& p = instance.mesh.positions;
    for (const glm::uvec3& t : instance.mesh.triangles) share.count(has(p[t.x], p[t.y], p[t.z]));
  });
  return share.value();
}

inline int zero_edges(const Instance& instance, const Ray& ray) {
  int zeros = 0;
  for (const witness::Facts& facts : witness::all_facts(ray, instance.mesh)) zeros += facts.zero_edges();
  return zeros;
}

/// Whether `fact` holds for the ray and any triangle.
template <typename Fact>
bool any_fact(const Instance& instance, const Ray& ray, const Fact& fact) {
  const std::vector<witness::Facts> facts = witness::all_facts(ray, instance.mesh);
  return std::any_of(facts.begin(), facts.end(), fact);
}

inline std::vector<oracle::Hit> all_hits(const Instance& instance, const Ray& ray) {
  return oracle::Scene(witness::to_oracle(instance.mesh)).all(witness::to_oracle(ray));
}

inline bool is_hit(const Instance& instance, const Ray& ray) { return !all_hits(instance, ray).empty(); }

}  // namespace plumb::cases
