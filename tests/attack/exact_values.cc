#include "attack/exact_values.h"

#include <cmath>
#include <limits>

namespace plumb::attack {
namespace {

constexpr unsigned kFloatBits = 149;

struct Vector {
  mpz_class x, y, z;
};

// value * 2^shift, a whole number.
mpz_class whole(double value, unsigned shift) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  mpz_class result(std::ldexp(mantissa, 53));
  const int bits = exponent - 53 + static_cast<int>(shift);
  if (bits >= 0) {
    mpz_mul_2exp(result.get_mpz_t(), result.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
  } else {
    mpz_tdiv_q_2exp(result.get_mpz_t(), result.get_mpz_t(), static_cast<mp_bitcnt_t>(-bits));
  }
  return result;
}

Vector whole(const glm::vec3& v) {
  return {whole(double{v.x}, kFloatBits), whole(double{v.y}, kFloatBits), whole(double{v.z}, kFloatBits)};
}

Vector minus(const Vector& p, const Vector& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

// p . (q x r), from units of 2^-149 each to units of 2^-kScaleBits.
mpz_class determinant(const Vector& p, const Vector& q, const Vector& r) {
  const mpz_class value =
      p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
  return value << (kScaleBits - 3 * kFloatBits);
}

}  // namespace

ExactValues::ExactValues(const glm::vec3& origin, const glm::vec3& direction,
                         const detail::Triangle& triangle) {
  const Vector o = whole(origin), d = whole(direction);
  const Vector a = minus(whole(triangle.v0), o), b = minus(whole(triangle.v1), o),
               c = minus(whole(triangle.v2), o);
  edge[0] = determinant(d, a, b);
  edge[1] = determinant(d, b, c);
  edge[2] = determinant(d, c, a);
  den = edge[0] + edge[1] + edge[2];
  t_num = determinant(a, b, c);
}

double share_of_bound(double computed, const mpz_class& exact, double bound) {
  const mpz_class error = abs(whole(computed, kScaleBits) - exact);
  if (error == 0) return 0.0;
  if (!(bound > 0.0)) return std::numeric_limits<double>::infinity();
  long exponent = 0;
  const double mantissa = mpz_get_d_2exp(&exponent, error.get_mpz_t());
  int bound_exponent = 0;
  const double bound_mantissa = std::frexp(bound, &bound_exponent);
  return std::ldexp(mantissa / bound_mantissa,
                    static_cast<int>(exponent) - static_cast<int>(kScaleBits) - bound_exponent);
}

}  // namespace plumb::attack
