#pragma once

#include <gmpxx.h>

#include "oracle/oracle.h"

namespace oracle {

/// value * 2^149: every finite float is a multiple of 2^-149.
mpz_class scaled(float value);

/// RN32(numerator / denominator), to nearest, ties to even, infinite from 2^128 - 2^103 on. The
/// denominator must not be zero.
float nearest_float(const mpz_class& numerator, const mpz_class& denominator);

/// RN32(value) for any double.
float nearest_float(double value);

}  // namespace oracle
