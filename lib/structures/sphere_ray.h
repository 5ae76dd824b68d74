#pragma once

#include "plumb/ray.h"
#include "structures/bounding_sphere.h"

namespace plumb::detail {

/// A ray against spheres in double, for any valid ray. Conservative: a sphere that holds a point of the ray
/// with an exact t that counts is met.
class SphereRay {
 public:
  explicit SphereRay(const Ray& ray);

  /// Whether the sphere may hold a point with t from tmin to `limit`; then `near` is a lower bound of its t,
  /// at least max(tmin, 0), as lower_float() has it.
  bool meets(const Sphere& sphere, float limit, float& near) const;

 private:
  double origin_[3];
  double direction_[3];
  double length2_;  // |d|^2
  double tmin_;
};

}  // namespace plumb::detail
