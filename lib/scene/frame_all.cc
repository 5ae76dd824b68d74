#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "base/fp_mode.h"
#include "base/round.h"
#include "plumb/builtin.h"
#include "plumb/error.h"

namespace plumb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
  glm::dvec3 lo{kInfinity, kInfinity, kInfinity};
  glm::dvec3 hi{-kInfinity, -kInfinity, -kInfinity};

  bool empty() const { return !(lo.x <= hi.x); }
  void grow(const glm::vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], double{p[axis]});
      hi[axis] = std::max(hi[axis], double{p[axis]});
    }
  }
};

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

Box box_of_finite_triangles(const MeshView& mesh) {
  Box box;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    const std::uint32_t greatest = std::max({t.x, t.y, t.z});
    if (greatest >= mesh.positions.size()) {
      throw Error("plumb: triangle " + std::to_string(i) + " has the vertex index " +
                  std::to_string(greatest) + ", but the mesh has only " +
                  std::to_string(mesh.positions.size()) + " positions");
    }
    const std::array<glm::vec3, 3> corners{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (!std::all_of(corners.begin(), corners.end(), is_finite)) continue;
    for (const glm::vec3& corner : corners) box.grow(corner);
  }
  return box;
}

double greatest_component(const glm::dvec3& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// How far from the box's centre the eye must be, looking along `forward`, for all its corners to be in
// view.
double fitting_distance(const glm::dvec3& half, const Camera& unit, const glm::dvec3& forward,
                        const glm::dvec3& right, const glm::dvec3& up) {
  const double half_width = -unit.corner.x, half_height = unit.corner.y;
  double distance = 0.0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
    const double sideways =
        std::max(std::fabs(dot(corner, right)) / half_width, std::fabs(dot(corner, up)) / half_height);
    distance = std::max(distance, sideways - dot(corner, forward));
  }
  return distance;
}

std::string text(const glm::dvec3& p) {
  std::ostringstream out;
  out << "(" << p.x << ", " << p.y << ", " << p.z << ")";
  return out.str();
}

glm::vec3 to_float(const glm::dvec3& p) {
  return {detail::round_to_float(p.x), detail::round_to_float(p.y), detail::round_to_float(p.z)};
}

[[gnu::noinline]] Camera make_frame_all(const MeshView& mesh, int width, int height, double fov_y_degrees) {
  // Along -z, so that its corner holds the half sizes of the picture; throws for a bad size or field of
  // view.
  const Camera unit = Camera::look_at({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f},
                                      fov_y_degrees, width, height);
  Box box = box_of_finite_triangles(mesh);
  if (box.empty()) box = {glm::dvec3(-1.0), glm::dvec3(1.0)};
  const glm::dvec3 centre((box.lo.x + box.hi.x) / 2, (box.lo.y + box.hi.y) / 2, (box.lo.z + box.hi.z) / 2);
  const glm::dvec3 half((box.hi.x - box.lo.x) / 2, (box.hi.y - box.lo.y) / 2, (box.hi.z - box.lo.z) / 2);

  // From (2, 3, 6) / 7: the front, a little to the right, and above.
  const glm::dvec3 forward(-2.0 / 7.0, -3.0 / 7.0, -6.0 / 7.0);
  const double horizontal = std::sqrt(40.0);
  const glm::dvec3 right(6.0 / horizontal, 0.0, -2.0 / horizontal);
  const glm::dvec3 up(right.y * forward.z - right.z * forward.y, right.z * forward.x - right.x * forward.z,
                      right.x * forward.y - right.y * forward.x);

  // A twentieth more than fits. A point, or a speck far from the origin, is seen from where rounding the eye
  // to float does not turn the view.
  double distance = 1.05 * fitting_distance(half, unit, forward, right, up);
  distance = std::max(distance, greatest_component(centre) * 0x1p-12);
  if (distance == 0.0) distance = 1.0;
  distance = std::max(distance, 0x1p-130);
  const glm::vec3 eye = to_float(
      {centre.x - distance * forward.x, centre.y - distance * forward.y, centre.z - distance * forward.z});
  if (!is_finite(eye)) {
    std::ostringstream message;
    message << "plumb: the mesh is so large (from " << text(box.lo) << " to " << text(box.hi)
            << ") that no eye with finite float coordinates sees all of it at a field of view of "
            << fov_y_degrees << " degrees; scale it down or give a camera";
    throw Error(message.str());
  }
  return Camera::look_at(eye, to_float(centre), {0.0f, 1.0f, 0.0f}, fov_y_degrees, width, height);
}

}  // namespace

Camera frame_all(MeshView mesh, int width, int height, double fov_y_degrees) {
  return detail::with_default_fp_mode([&] { return make_frame_all(mesh, width, height, fov_y_degrees); });
}

}  // namespace plumb
