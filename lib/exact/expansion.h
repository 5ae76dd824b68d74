#pragma once

#include <cmath>

// Exact sums of doubles, after Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast
// Robust Geometric Predicates". An expansion is a sum of non-overlapping doubles in order of
// increasing magnitude; its sign is that of the last one. Exact as long as nothing overflows or
// underflows, which float inputs cannot cause here (docs/visibility.md, "Getting there fast", 3).

namespace plumb::detail {

/// a + b = sum + error, exactly (Knuth).
inline void two_sum(double a, double b, double& sum, double& error) {
  sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  error = (a - a_part) + (b - b_part);
}

/// a * b = product + error, exactly (Dekker's splitting: no fused multiply-add, which not every
/// target has). |a|, |b| must stay below 2^995 so that the splitting does not overflow.
inline void two_product(double a, double b, double& product, double& error) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  product = a * b;
  const double a_big = kSplitter * a;
  const double a_hi = a_big - (a_big - a);
  const double a_lo = a - a_hi;
  const double b_big = kSplitter * b;
  const double b_hi = b_big - (b_big - b);
  const double b_lo = b - b_hi;
  error = a_lo * b_lo - (((product - a_hi * b_hi) - a_lo * b_hi) - a_hi * b_lo);
}

/// A sum of at most `Capacity` additions.
template <int Capacity>
class Expansion {
 public:
  /// Adds one double (grow-expansion with zero elimination).
  void add(double value) {
    double carry = value;
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      double sum = 0.0;
      double error = 0.0;
      two_sum(carry, part_[i], sum, error);
      if (error != 0.0) part_[kept++] = error;
      carry = sum;
    }
    if (carry != 0.0) part_[kept++] = carry;
    size_ = kept;
  }

  /// Adds a * b; takes two additions of the capacity.
  void add_product(double a, double b) {
    double product = 0.0;
    double error = 0.0;
    two_product(a, b, product, error);
    if (error != 0.0) add(error);
    add(product);
  }

  /// Adds factor * other; takes twice the other's size.
  template <int OtherCapacity>
  void add_scaled(const Expansion<OtherCapacity>& other, double factor) {
    for (int i = 0; i < other.size(); ++i) add_product(other.part(i), factor);
  }

  int size() const { return size_; }
  double part(int i) const { return part_[i]; }

  /// -1, 0 or 1.
  int sign() const { return size_ == 0 ? 0 : (part_[size_ - 1] > 0.0 ? 1 : -1); }

  /// The nearest double but for a few units in the last place; 0 only if the sum is 0.
  double estimate() const {
    double sum = 0.0;
    for (int i = 0; i < size_; ++i) sum += part_[i];
    return sum;
  }

 private:
  int size_ = 0;
  double part_[Capacity];
};

}  // namespace plumb::detail
