#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "exact/intersect.h"
#include "plumb/ray.h"
#include "support/random.h"

// A search for the input on which a bound is tightest: random starts, each improved step by step by changes
// that keep what is found as long as it does not get worse (hill climbing with plateau moves).

namespace plumb::attack {

/// A ray's origin and direction and a triangle's corners, as numbers to change.
struct Input {
  std::array<float, 15> value;

  glm::vec3 point(std::size_t i) const { return {value[3 * i], value[3 * i + 1], value[3 * i + 2]}; }
  glm::vec3 origin() const { return point(0); }
  glm::vec3 direction() const { return point(1); }
  detail::Triangle triangle() const { return {point(2), point(3), point(4)}; }
};

inline float random_float(hard::Random& random, int least_exponent, int greatest_exponent) {
  const float mantissa = random.unit();
  return std::ldexp(mantissa, random.between(least_exponent, greatest_exponent));
}

/// Numbers of up to about 2^scale, some down to 2^-depth of that, around a centre of about that size; in half
/// of the inputs the ray is aimed at an edge.
inline Input random_input(hard::Random& random, int scale, int depth) {
  Input input{};
  const int centre_scale = scale + random.between(-4, 4);
  const float centre[3] = {random_float(random, centre_scale, centre_scale),
                           random_float(random, centre_scale, centre_scale),
                           random_float(random, centre_scale, centre_scale)};
  for (std::size_t i = 0; i < input.value.size(); ++i) {
    const bool is_direction = i >= 3 && i < 6;
    const float around = is_direction ? 0.0f : centre[i % 3];
    input.value[i] = around + random_float(random, scale - depth, scale);
  }
  if (random.one_in(2)) {
    const float share = 0.5f * (random.unit() + 1.0f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = input.value[6 + axis], b = input.value[9 + axis];
      input.value[3 + axis] = a + (b - a) * share - input.value[axis];
    }
  }
  return input;
}

/// Changes one or two numbers: by a few floats, to another's value, in size, to fewer or to all bits.
inline void mutate(hard::Random& random, Input& input) {
  const auto any = [&] { return random.below(static_cast<std::uint32_t>(input.value.size())); };
  for (int n = random.between(1, 2); n > 0; --n) {
    float& f = input.value[any()];
    switch (random.below(8)) {
      case 0:
      case 1:
      case 2:
        for (int steps = random.between(1, 4); steps > 0; --steps)
          f = std::nextafter(f, random.one_in(2) ? 1e30f : -1e30f);
        break;
      case 3:
        f += std::ldexp(f, -random.between(1, 24));
        break;
      case 4:
        f = input.value[any()];
        break;
      case 5:
        f = -f;
        break;
      case 6:
        f *= random.one_in(2) ? 2.0f : 0.5f;
        break;
      default:
        f = std::ldexp(random.unit(), std::ilogb(f == 0.0f ? 1.0f : f) + 1);
    }
  }
}

/// The greatest objective(input) found. The objective returns something below 0 for an input that does
/// not count.
template <typename Draw, typename Objective>
double climb(hard::Random& random, int starts, int steps, Draw draw, Objective objective) {
  double greatest = -1.0;
  for (int start = 0; start < starts; ++start) {
    Input best = draw(random);
    double value = objective(best);
    for (int step = 0; step < steps; ++step) {
      Input changed = best;
      mutate(random, changed);
      const double reached = objective(changed);
      if (reached >= value) {
        value = reached;
        best = changed;
      }
    }
    greatest = std::max(greatest, value);
  }
  return greatest;
}

}  // namespace plumb::attack
