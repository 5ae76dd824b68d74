#include "support/hard_cameras.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "plumb/error.h"
#include "support/hard_scenes.h"

namespace plumb::hard {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Odd sizes, a single pixel, and sizes at the edge of what tiles and vectors hold.
std::pair<int, int> size(Random& random) {
  return random.pick(
      std::vector<std::pair<int, int>>{{37, 23}, {37, 23}, {33, 17}, {1, 1}, {67, 9}, {5, 41}, {32, 32}});
}

// The finite corners of the mesh's triangles; never empty.
std::vector<glm::vec3> corners(const TriangleMesh& mesh) {
  std::vector<glm::vec3> result;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& v = mesh.positions[t[i]];
      if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) result.push_back(v);
    }
  }
  if (result.empty()) result.emplace_back(0.0f, 0.0f, 1.0f);
  return result;
}

// A power of two of about the scene's size, small enough that nothing overflows for lack of care.
float scale(const TriangleMesh& mesh) {
  float greatest = 0.0f;
  for (const glm::vec3& v : corners(mesh))
    greatest = std::max({greatest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return greatest == 0.0f ? 1.0f : std::ldexp(1.0f, std::clamp(std::ilogb(greatest), -145, 90));
}

// look_at, or a plain view from the origin where it refuses.
Camera looking(Random& random, glm::vec3 eye, glm::vec3 target, double fov) {
  const auto [width, height] = size(random);
  const glm::vec3 up = random.one_in(2) ? glm::vec3(0, 1, 0) : random.unit3();
  constexpr float kMax = std::numeric_limits<float>::max();
  for (int i = 0; i < 3; ++i) eye[i] = std::clamp(eye[i], -kMax, kMax);
  try {
    return Camera::look_at(eye, target, up, fov, width, height);
  } catch (const Error&) {
    return Camera::look_at({0, 0, 0}, {1, 0.5f, -0.25f}, {0, 1, 0}, fov, width, height);
  }
}

Camera outside(Random& random, const TriangleMesh& mesh) {
  const glm::vec3 target = random.pick(corners(mesh));
  const glm::vec3 eye = target + 2.5f * scale(mesh) * random.unit3();
  return looking(random, eye, target, 30.0 + random.below(40));
}

Camera inside(Random& random, const TriangleMesh& mesh) {
  const glm::vec3 eye = scale(mesh) * random.unit3();
  const glm::vec3 target = random.pick(corners(mesh));
  return looking(random, eye, target, 40.0 + random.below(130));
}

// The eye on a vertex, an edge or a surface.
Camera touching(Random& random, const TriangleMesh& mesh) {
  const std::vector<glm::vec3> points = corners(mesh);
  const std::size_t first = random.below(static_cast<std::uint32_t>(points.size())) / 3 * 3;
  const glm::vec3 eye = random.one_in(2) || points.size() < first + 3
                            ? points[first]
                            : 0.5f * points[first] + 0.5f * (random.one_in(2) ? points[first + 1]
                                                                              : 0.5f * points[first + 1] +
                                                                                    0.5f * points[first + 2]);
  return looking(random, eye, random.pick(points), 60.0);
}

// From far away through a narrow view: rounded directions show.
Camera far_and_narrow(Random& random, const TriangleMesh& mesh) {
  const float distance = std::ldexp(1.0f, random.between(5, 18));
  const glm::vec3 target = random.pick(corners(mesh));
  return looking(random, target + distance * scale(mesh) * random.unit3(), target, 100.0 / double{distance});
}

// An orthogonal raster of directions. Its pixels' centres step by `step` about `forward` along `axis`.
Camera raster(Random& random, glm::vec3 eye, double step, double forward) {
  const auto [width, height] = size(random);
  const int axis = random.between(0, 2);
  glm::dvec3 corner(0.0), du(0.0), dv(0.0);
  du[(axis + 1) % 3] = step;
  dv[(axis + 2) % 3] = -step;
  // This pixel looks straight along the axis.
  const int middle_x = width / 2, middle_y = height / 2;
  corner = -(middle_x + 0.5) * du - (middle_y + 0.5) * dv;
  corner[axis] = forward;
  return Camera(eye, corner, du, dv, width, height);
}

// Every pixel's ray on a lattice: through the vertices and edges of lattice scenes.
Camera lattice(Random& random, const TriangleMesh& mesh) {
  const double unit = double{scale(mesh)};
  const glm::vec3 eye = static_cast<float>(unit * 0.25) * random.lattice3(16);
  const double step = std::ldexp(unit, -random.between(1, 4));
  return raster(random, eye, step, random.one_in(2) ? 4.0 * unit : -2.0 * unit);
}

// Directions at the ends of the floats' range: subnormal, rounding to zero, rounding to infinity.
Camera extreme(Random& random, const TriangleMesh& mesh) {
  const double length = random.pick(
      std::vector<double>{0x1p-149, 0x1p-151, 0x1p-140, 0x1p-126, 0x1p124, 0x1p127, 1e-300, 1e300});
  return raster(random, scale(mesh) * random.unit3(), length / 16.0, length);
}

// Frames that no look_at makes: a pixel without direction, steps that are zero, parallel or not finite.
Camera degenerate(Random& random, const TriangleMesh& mesh) {
  const glm::vec3 eye = scale(mesh) * random.unit3();
  Camera camera = looking(random, eye, random.pick(corners(mesh)), 60.0);
  switch (random.below(7)) {
    case 0:
      camera = raster(random, camera.eye, 0.125, 0.0);
      break;
    case 1:
      camera.du = glm::dvec3(0.0);
      break;
    case 2:
      camera.dv = camera.du;
      break;
    case 3: {
      const int axis = random.between(0, 2);
      camera.dv[axis] = random.one_in(2) ? kInf : std::numeric_limits<double>::quiet_NaN();
      break;
    }
    case 4:
      camera.corner = camera.du = camera.dv = glm::dvec3(0.0);
      break;
    case 5:
      camera.corner[random.between(0, 2)] = 1e39;
      break;
    default:
      camera.eye[random.between(0, 2)] = std::numeric_limits<float>::infinity();
      break;
  }
  return camera;
}

// Axes that are neither perpendicular nor of one length, mirrored or not.
Camera skewed(Random& random, const TriangleMesh& mesh) {
  const auto [width, height] = size(random);
  const auto axis = [&](float length) { return glm::dvec3(length * random.unit3()); };
  const glm::vec3 eye = scale(mesh) * random.unit3();
  const glm::dvec3 corner = axis(1.0f), du = axis(0.1f), dv = axis(0.1f);
  return Camera(eye, corner, du, dv, width, height);
}

constexpr CameraKind kKinds[] = {
    {"outside", outside},       {"inside", inside},
    {"touching", touching},     {"far_and_narrow", far_and_narrow},
    {"lattice", lattice},       {"extreme", extreme},
    {"degenerate", degenerate}, {"skewed", skewed},
};

}  // namespace

std::span<const CameraKind> camera_kinds() { return kKinds; }

Camera camera_of_kind(Random& random, const TriangleMesh& mesh, std::string_view kind) {
  return kind_called(kKinds, kind).make(random, mesh);
}

}  // namespace plumb::hard
