#include "scene/mesh_builder.h"

#include <cmath>
#include <numbers>

namespace plumb::detail {

Turn turn(double share) {
  const double nearest_quarter = std::floor(4.0 * share + 0.5);
  const double x = (share - 0.25 * nearest_quarter) * (2.0 * std::numbers::pi);
  const double x2 = x * x;
  // 1 - x2/(1*2) (1 - x2/(3*4) (1 - ...)) and x (1 - x2/(2*3) (1 - x2/(4*5) (1 - ...))).
  double cosine = 1.0;
  double sine = 1.0;
  for (int i = 8; i >= 1; --i) {
    cosine = 1.0 - x2 / ((2 * i - 1) * (2 * i)) * cosine;
    sine = 1.0 - x2 / ((2 * i) * (2 * i + 1)) * sine;
  }
  sine *= x;
  const double quarter = nearest_quarter - 4.0 * std::floor(0.25 * nearest_quarter);
  if (quarter == 0.0) return {cosine, sine};
  if (quarter == 1.0) return {-sine, cosine};
  if (quarter == 2.0) return {-cosine, -sine};
  return {sine, -cosine};
}

}  // namespace plumb::detail
