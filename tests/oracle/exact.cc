#include "oracle/exact.h"

#include <bit>
#include <cmath>

namespace oracle {
namespace {

constexpr int kPrecision = 24;          // bits of a float's significand
constexpr int kLeastExponent = -149;    // of a float's last place
constexpr int kGreatestExponent = 128;  // no float reaches 2 to this

// numerator * 2^-exponent / denominator as a fraction of integers.
void divide_by_power_of_two(mpz_class& numerator, mpz_class& denominator, long exponent) {
  if (exponent >= 0) {
    denominator <<= static_cast<unsigned long>(exponent);
  } else {
    numerator <<= static_cast<unsigned long>(-exponent);
  }
}

// floor(log2(numerator / denominator)), both positive.
long floor_log2(const mpz_class& numerator, const mpz_class& denominator) {
  const auto bits = [](const mpz_class& z) { return static_cast<long>(mpz_sizeinbase(z.get_mpz_t(), 2)); };
  // 2^(bits - 1) <= z < 2^bits for each, so the answer is this guess or one less.
  const long guess = bits(numerator) - bits(denominator);
  mpz_class n = numerator;
  mpz_class d = denominator;
  divide_by_power_of_two(n, d, guess);
  return n >= d ? guess : guess - 1;
}

}  // namespace

mpz_class scaled(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t field = (bits >> 23) & 0xffu;
  const std::uint32_t fraction = bits & 0x7fffffu;
  // A subnormal has the exponent of the field 1 and no leading one.
  mpz_class result = field == 0 ? fraction : (fraction | 0x800000u);
  if (field > 1) result <<= field - 1;
  if ((bits >> 31) != 0) result = -result;
  return result;
}

float nearest_float(const mpz_class& numerator, const mpz_class& denominator) {
  mpz_class n = abs(numerator);
  mpz_class d = abs(denominator);
  if (n == 0) return 0.0f;
  // The result is an integer `significand` of at most 24 bits times 2^exponent.
  const long exponent = std::max<long>(floor_log2(n, d) - (kPrecision - 1), kLeastExponent);
  divide_by_power_of_two(n, d, exponent);
  mpz_class significand;
  mpz_class remainder;
  mpz_fdiv_qr(significand.get_mpz_t(), remainder.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
  const int against_half = cmp(2 * remainder, d);
  const bool odd = mpz_odd_p(significand.get_mpz_t()) != 0;
  if (against_half > 0 || (against_half == 0 && odd)) ++significand;
  // Rounding up may have made it 2^24, which is a float all the same, or infinity.
  const bool overflow = significand != 0 && floor_log2(significand, 1) + exponent >= kGreatestExponent;
  const float magnitude =
      overflow ? std::numeric_limits<float>::infinity()
               : std::ldexp(static_cast<float>(significand.get_ui()), static_cast<int>(exponent));
  return sgn(numerator) * sgn(denominator) < 0 ? -magnitude : magnitude;
}

float nearest_float(double value) {
  if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
  if (std::isinf(value))
    return std::copysign(std::numeric_limits<float>::infinity(), value > 0 ? 1.0f : -1.0f);
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  mpz_class numerator(std::ldexp(fraction, 53));  // an integer, converted exactly
  mpz_class denominator(1);
  divide_by_power_of_two(numerator, denominator, 53L - exponent);
  return nearest_float(numerator, denominator);
}

}  // namespace oracle
