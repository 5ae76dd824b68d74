#include "structures/sphere_ray.h"

#include <algorithm>
#include <cmath>

#include "trace/box_ray.h"

namespace plumb::detail {

SphereRay::SphereRay(const Ray& ray)
    : origin_{double{ray.origin.x}, double{ray.origin.y}, double{ray.origin.z}},
      direction_{double{ray.direction.x}, double{ray.direction.y}, double{ray.direction.z}},
      length2_((direction_[0] * direction_[0] + direction_[1] * direction_[1]) +
               direction_[2] * direction_[2]),
      tmin_(ray.tmin > 0.0f ? double{ray.tmin} : 0.0) {}

// The ray is within the sphere while A t^2 - 2 B t + C <= 0, with L = c - o, A = d.d, B = L.d, C = L.L - r^2,
// so from (B - sqrt(q)) / A to (B + sqrt(q)) / A, q = B^2 - A C.
//
// Errors as computed, u = 2^-53, to first order: L off by u of itself; B by 4 u w, where w = sum |L_i d_i| is
// at most sqrt(A L.L); A by 3 u of itself, L.L by 5 u, r^2 by nothing (a float's square). So
//   B^2: 2 |B| 4 u w + u B^2 <= 9 u A L.L
//   C:   5 u L.L + u (L.L + r^2) = 6 u L.L + u r^2
//   A C: (3 + 1) u A (L.L + r^2) + A (6 u L.L + u r^2) = A u (10 L.L + 5 r^2)
//   q:   9 u A L.L + A u (10 L.L + 5 r^2) + u (A L.L + A (L.L + r^2)) = A u (21 L.L + 6 r^2)
// and 32 u A (L.L + r^2) bounds it with all higher orders. Each end's numerator has B's 4 u w, the root's 2 u
// of itself and the last sum's u (w + root): together less than 8 u (w + root). The quotient adds A's 3 u and
// its own. All is below 2^600 and, where it is not 0, above 2^-600, so nothing overflows or underflows in
// double; an infinite radius makes q and both ends infinite, and the sphere is met.
bool SphereRay::meets(const Sphere& sphere, float limit, float& near) const {
  constexpr double kU = 0x1p-53;
  double square = 0.0, along = 0.0, size = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double l = double{sphere.center[axis]} - origin_[axis];
    const double product = l * direction_[axis];
    square += l * l;
    along += product;
    size += std::fabs(product);
  }
  const double radius2 = double{sphere.radius} * double{sphere.radius};
  const double q = along * along - length2_ * (square - radius2) + 32.0 * kU * length2_ * (square + radius2);
  if (q < 0.0) return false;
  const double root = std::sqrt(q);
  const double slack = 8.0 * kU * (size + root);
  const double last = (along + root) + slack;
  if (last < 0.0) return false;
  const double first = (along - root) - slack;
  const double nearest = std::max(tmin_, first / length2_ * (1.0 - 8.0 * kU));
  const double farthest = std::min(double{limit}, last / length2_ * (1.0 + 8.0 * kU));
  if (!(nearest <= farthest)) return false;
  near = lower_float(nearest);
  return true;
}

}  // namespace plumb::detail
