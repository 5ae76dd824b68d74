#pragma once

#include <glm/vec3.hpp>

#include "exact/expansion.h"

// Determinants of float vectors as exact sums.

namespace plumb::detail {

struct ExactNormal {
  Expansion<6> x, y, z;
};

/// Adds p x q.
inline void add_cross(ExactNormal& n, const glm::vec3& p, const glm::vec3& q) {
  const struct { double x, y, z; } a{p.x, p.y, p.z}, b{q.x, q.y, q.z};
  // A product of two floats is exact in double.
  n.x.add(a.y * b.z);
  n.x.add(-(a.z * b.y));
  n.y.add(a.z * b.x);
  n.y.add(-(a.x * b.z));
  n.z.add(a.x * b.y);
  n.z.add(-(a.y * b.x));
}

/// (p - r) x (q - r) = p x q + q x r + r x p
inline ExactNormal cross_about(const glm::vec3& p, const glm::vec3& q, const glm::vec3& r) {
  ExactNormal n;
  add_cross(n, p, q);
  add_cross(n, q, r);
  add_cross(n, r, p);
  return n;
}

/// Adds factor * (n . p) for a factor of 1 or -1.
template <int Capacity>
void add_dot(Expansion<Capacity>& sum, const ExactNormal& n, const glm::vec3& p, double factor) {
  // Such a factor leaves the coordinates exact.
  sum.add_scaled(n.x, factor * double{p.x});
  sum.add_scaled(n.y, factor * double{p.y});
  sum.add_scaled(n.z, factor * double{p.z});
}

}  // namespace plumb::detail
