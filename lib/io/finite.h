#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace plumb::detail {

inline bool is_finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace plumb::detail
