#include "io/degenerate.h"

#include <cmath>

#include "exact/double_stage.h"
#include "exact/expansion.h"

namespace plumb::detail {
namespace {

// (b - a) (f - c) - (d - c) (e - a), exactly, zero or not: a component of the cross product of two edges.
// Each difference of floats is a sum of two doubles; eight products of those, of two doubles each.
bool is_zero(float a, float b, float c, float d, float e, float f) {
  double hi[4], lo[4];
  two_sum(double{b}, -double{a}, hi[0], lo[0]);
  two_sum(double{f}, -double{c}, hi[1], lo[1]);
  two_sum(double{d}, -double{c}, hi[2], lo[2]);
  two_sum(double{e}, -double{a}, hi[3], lo[3]);
  Expansion<16> sum;
  for (const double x : {hi[0], lo[0]}) {
    for (const double y : {hi[1], lo[1]}) sum.add_product(x, y);
  }
  for (const double x : {hi[2], lo[2]}) {
    for (const double y : {hi[3], lo[3]}) sum.add_product(-x, y);
  }
  return sum.sign() == 0;
}

}  // namespace

bool has_no_area(const Triangle& t) {
  // In double first, whose bound exact/double_stage.h derives.
  const DoubleStage stage(t.v0, glm::vec3(0.0f), t);
  if (norm_max(stage.n) > stage.n_error) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    if (!is_zero(t.v0[y], t.v1[y], t.v0[z], t.v1[z], t.v2[y], t.v2[z])) return false;
  }
  return true;
}

}  // namespace plumb::detail
