#include "trace/watertight_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/round.h"

namespace plumb::detail {
namespace {

constexpr float kGreatest = std::numeric_limits<float>::max();

int greatest_axis(const glm::vec3& d) {
  const int axis = std::fabs(d.x) > std::fabs(d.y) ? 0 : 1;
  return std::fabs(d[axis]) > std::fabs(d.z) ? axis : 2;
}

}  // namespace

WatertightRay::WatertightRay(const Ray& ray, const Box& box, float greatest)
    : tmin(ray.tmin > 0.0f ? ray.tmin : 0.0f), in_range(greatest < 0x1p40f) {
  k[2] = greatest_axis(ray.direction);
  k[0] = (k[2] + 1) % 3;
  k[1] = (k[2] + 2) % 3;
  const float along = ray.direction[k[2]];
  in_range = in_range && std::fabs(along) > 0x1p-60f && std::fabs(along) < 0x1p60f;
  for (int i = 0; i < 2; ++i) shear[i] = ray.direction[k[i]] / along;
  inverse_z = 1.0f / along;

  const auto reach = [&](int axis) {
    const float o = ray.origin[axis];
    return std::max(std::fabs(box.lo[axis] - o), std::fabs(box.hi[axis] - o));
  };
  const float reach_z = reach(k[2]);
  for (int i = 0; i < 3; ++i) {
    const int axis = k[i];
    const float o = origin[i] = ray.origin[axis];
    in_range = in_range && std::fabs(o) < 0x1p40f;
    const float grow =
        i == 2 ? 0.0f : 5.0f * 0x1p-24f * (reach(axis) + reach_z) + (0x1p-23f * std::fabs(o) + 0x1p-100f);
    const float low = o - grow;
    const float high = o + grow;
    const bool forward = !std::signbit(ray.direction[axis]);
    const double inverse = 1.0 / double{ray.direction[axis]};
    const auto cut = [](double x) {
      return static_cast<float>(std::clamp(x, -double{kGreatest}, double{kGreatest}));
    };
    inv_near[axis] = cut(inverse * (1.0 - 4.0 * 0x1p-24));
    inv_far[axis] = cut(inverse * (1.0 + 4.0 * 0x1p-24));
    box_origin_near[axis] = forward ? high : low;
    box_origin_far[axis] = forward ? low : high;
    near_row[axis] = 2 * static_cast<std::uint32_t>(axis) + (forward ? 0 : 1);
    far_row[axis] = 2 * static_cast<std::uint32_t>(axis) + (forward ? 1 : 0);
  }
}

bool watertight_hit(const WatertightRay& ray, const Triangle& triangle, float& t) {
  const glm::vec3* const corner[3] = {&triangle.v0, &triangle.v1, &triangle.v2};
  double x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    const float depth = (*corner[i])[ray.k[2]] - ray.origin[2];
    x[i] = double{((*corner[i])[ray.k[0]] - ray.origin[0]) - ray.shear[0] * depth};
    y[i] = double{((*corner[i])[ray.k[1]] - ray.origin[1]) - ray.shear[1] * depth};
    z[i] = double{depth};
  }
  const double u = x[2] * y[1] - y[2] * x[1];
  const double v = x[0] * y[2] - y[0] * x[2];
  const double w = x[1] * y[0] - y[1] * x[0];
  const double sum = (u + v) + w;
  if ((std::min({u, v, w}) < 0.0 && std::max({u, v, w}) > 0.0) || sum == 0.0) return false;
  t = round_to_float(((u * z[0] + v * z[1]) + w * z[2]) / sum * double{ray.inverse_z});
  return true;
}

}  // namespace plumb::detail
