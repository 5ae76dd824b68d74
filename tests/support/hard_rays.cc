#include "support/hard_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace plumb::hard {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

float greatest(glm::vec3 v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

using Corners = std::array<glm::vec3, 3>;

// What a ray may aim at.
class Targets {
 public:
  Targets(Random& random, const TriangleMesh& mesh) : random_(random) {
    for (const glm::uvec3& t : mesh.triangles) {
      const Corners c = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
      if (is_finite(c[0]) && is_finite(c[1]) && is_finite(c[2])) triangles_.push_back(c);
    }
    if (triangles_.empty())
      triangles_.push_back({glm::vec3{0, 0, 1}, glm::vec3{1, 0, 1}, glm::vec3{0, 1, 1}});
    float size = 0.0f;
    for (const Corners& c : triangles_)
      size = std::max({size, greatest(c[0]), greatest(c[1]), greatest(c[2])});
    exponent_ = size == 0.0f ? 0 : std::ilogb(size);
    choose();
  }

  /// Another triangle, with its corners turned.
  void choose() {
    Corners c = random_.pick(triangles_);
    std::rotate(c.begin(), c.begin() + random_.between(0, 2), c.end());
    triangle_ = c;
  }

  glm::vec3 v0() const { return triangle_[0]; }
  glm::vec3 e1() const { return difference(triangle_[1], triangle_[0]); }
  glm::vec3 e2() const { return difference(triangle_[2], triangle_[0]); }

  /// A point of an edge's line, most often of the edge, exact where the coordinates are coarse.
  glm::vec3 on_edge() { return v0() + 0.25f * static_cast<float>(random_.between(-1, 5)) * e1(); }

  glm::vec3 inside() {
    const int i = random_.between(1, 6), j = random_.between(1, 7 - i);
    return (v0() + 0.125f * static_cast<float>(i) * e1()) + 0.125f * static_cast<float>(j) * e2();
  }

  /// Any point of the triangle's plane.
  glm::vec3 in_plane() {
    const auto i = static_cast<float>(random_.between(-2, 2)), j = static_cast<float>(random_.between(-3, 3));
    return (v0() + i * e1()) + 0.5f * j * e2();
  }

  /// Where a ray may begin: anywhere about the scene, on a lattice of the scene's own scale, or at a
  /// vertex mirrored in another, so that both signs of t and exact differences occur.
  glm::vec3 origin() {
    switch (random_.below(3)) {
      case 0:
        return scale(1) * random_.unit3();
      case 1:
        return scale(-1) * random_.lattice3(6);
      default: {
        const Corners& corners = random_.pick(triangles_);
        const glm::vec3 mirror = corners[random_.below(3)];
        return mirror - difference(v0(), mirror);
      }
    }
  }

  /// A power of two of about the scene's size, times 2^more, below the greatest float's.
  float scale(int more) const { return std::ldexp(1.0f, std::min(exponent_ + more, 125)); }

  /// b - a, halved where that would overflow.
  static glm::vec3 difference(glm::vec3 b, glm::vec3 a) {
    const glm::vec3 d = b - a;
    return is_finite(d) ? d : 0.5f * b - 0.5f * a;
  }

  /// The distance along the ray to the chosen triangle's plane, nearly.
  float depth(const Ray& ray) const {
    const auto sub = [](glm::vec3 a, glm::vec3 b) { return glm::dvec3(a) - glm::dvec3(b); };
    const glm::dvec3 p = sub(triangle_[1], triangle_[0]), q = sub(triangle_[2], triangle_[0]);
    const glm::dvec3 n(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
    const glm::dvec3 a = sub(triangle_[0], ray.origin);
    const glm::dvec3 d(ray.direction);
    return static_cast<float>((n.x * a.x + n.y * a.y + n.z * a.z) / (n.x * d.x + n.y * d.y + n.z * d.z));
  }

 private:
  Random& random_;
  std::vector<Corners> triangles_;
  int exponent_ = 0;
  Corners triangle_{};
};

Ray through(glm::vec3 origin, glm::vec3 point) {
  Ray ray;
  ray.origin = origin;
  ray.direction = Targets::difference(point, origin);
  return ray;
}

Ray along(glm::vec3 origin, glm::vec3 direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

// ---- The kinds of rays.

Ray at_vertex(Random&, Targets& t) { return through(t.origin(), t.v0()); }

Ray at_edge(Random&, Targets& t) {
  const glm::vec3 origin = t.origin();
  return through(origin, t.on_edge());
}

Ray at_inside(Random&, Targets& t) {
  const glm::vec3 origin = t.origin();
  return through(origin, t.inside());
}

Ray along_edge(Random& random, Targets& t) {
  return along(t.v0() - 0.5f * static_cast<float>(random.between(-3, 4)) * t.e1(), t.e1());
}

Ray in_plane(Random&, Targets& t) {
  const glm::vec3 origin = t.in_plane();
  return through(origin, t.in_plane());
}

// Parallel to an axis or a coordinate plane, with zeros of both signs.
Ray axis_parallel(Random& random, Targets& t) {
  const int axis = random.between(0, 2);
  glm::vec3 origin = random.one_in(3) ? t.v0() : random.one_in(2) ? t.on_edge() : t.inside();
  glm::vec3 direction;
  for (int i = 0; i < 3; ++i) direction[i] = random.one_in(2) ? 0.0f : -0.0f;
  direction[axis] = random.one_in(2) ? 1.0f : -1.0f;
  origin[axis] -= direction[axis] * t.scale(1) * 0.25f * static_cast<float>(random.between(0, 8));
  if (random.one_in(4)) direction[(axis + 1) % 3] = random.unit();
  return along(origin, direction);
}

Ray from_vertex(Random& random, Targets& t) {
  const glm::vec3 origin = t.v0();
  if (random.one_in(2)) return along(origin, random.unit3());
  t.choose();
  return through(origin, random.one_in(2) ? t.v0() : t.inside());
}

Ray from_edge(Random&, Targets& t) {
  const glm::vec3 origin = t.on_edge();
  t.choose();
  return through(origin, t.on_edge());
}

Ray from_surface(Random& random, Targets& t) {
  const glm::vec3 origin = t.inside();
  if (random.one_in(2)) return along(origin, random.unit3());
  t.choose();
  return through(origin, t.v0());
}

// From just above the surface: det(a, b, c) is small against its terms.
Ray from_near_surface(Random& random, Targets& t) {
  const glm::vec3 point = t.inside();
  const float height = t.scale(-random.between(8, 24));
  const glm::vec3 origin = point + height * random.unit3();
  return random.one_in(2) ? through(origin, t.inside()) : along(origin, random.unit3());
}

// From (0, 0, 0) through a point with small integer coordinates in the corners' own basis, or one unit
// beside it: exactly or nearly on an edge of the "unimodular" scenes.
Ray from_zero(Random& random, Targets& t) {
  const auto weight = [&](int greatest) { return static_cast<float>(random.between(-1, greatest)); };
  const glm::vec3 v0 = t.v0(), v1 = v0 + t.e1(), v2 = v0 + t.e2();
  const float w0 = weight(3), w1 = weight(3), w2 = weight(1);
  glm::vec3 direction = w0 * v0 + w1 * v1 + w2 * v2;
  const int axis = random.between(0, 2);
  direction[axis] += static_cast<float>(random.between(-1, 1));
  return along(glm::vec3(0.0f), direction);
}

// Straight at a triangle across an axis, so that t = height / speed. That is made the midpoint of two
// floats, or as near to one as a ratio of floats can be, in the normal or the subnormal range.
Ray at_midpoint(Random& random, Targets& t) {
  int axis = -1;
  for (int tries = 0; tries < 8 && axis < 0; ++tries) {
    t.choose();
    for (int i = 0; i < 3; ++i) axis = t.e1()[i] == 0.0f && t.e2()[i] == 0.0f && t.v0()[i] != 0.0f ? i : axis;
  }
  glm::vec3 origin = t.inside();
  glm::vec3 direction(0.0f);
  if (axis < 0) return along(t.origin(), origin);
  const float level = origin[axis];
  const auto odd = [&] { return 2 * random.below(1u << 23) + 1; };
  switch (random.below(3)) {
    case 0:  // level + odd * 2^-24 level: 25 bits, the last one set
      origin[axis] = -static_cast<float>(odd()) * 0x1p-24f * level;
      direction[axis] = std::ldexp(level, random.between(-30, 30));
      break;
    case 1:  // small integers, or halves of them, times 2^-149
      origin[axis] = level - static_cast<float>(random.between(-8, 8)) * std::ldexp(level, -23);
      direction[axis] = std::ldexp(level, random.between(123, 127));
      break;
    default: {
      // height / speed = (m +- 1 / speed) / 2^25 with odd m < 2^25, for m speed = +-1 modulo 2^25.
      const std::uint32_t speed = odd();
      std::uint32_t inverse = speed;  // Newton's iteration doubles the 3 bits that are right
      for (int i = 0; i < 4; ++i) inverse *= 2 - speed * inverse;
      const std::uint32_t m = (random.one_in(2) ? inverse : 0 - inverse) & ((1u << 25) - 1);
      const std::uint64_t height = (std::uint64_t{m} * speed + (1u << 24)) >> 25;
      const float unit = std::ldexp(level, -24);
      origin[axis] = level - static_cast<float>(height) * unit;
      direction[axis] = static_cast<float>(speed) * unit;
      break;
    }
  }
  return along(origin, direction);
}

// From up to 2^30 scene sizes away.
Ray from_afar(Random& random, Targets& t) {
  const glm::vec3 point = random.one_in(2) ? t.v0() : random.one_in(2) ? t.on_edge() : t.inside();
  const glm::vec3 direction = random.one_in(2) ? random.unit3() : random.lattice3(2);
  return along(point - t.scale(random.between(2, 30)) * direction, direction);
}

Ray anywhere(Random& random, Targets& t) {
  const glm::vec3 origin = t.origin();
  return along(origin, random.unit3());
}

// A ray with something in it that makes it none.
Ray not_a_ray(Random& random, Targets& t) {
  Ray ray = at_inside(random, t);
  const float bad = random.one_in(2) ? kNan : random.one_in(2) ? kInf : -kInf;
  switch (random.below(4)) {
    case 0:
      ray.origin[random.between(0, 2)] = bad;
      break;
    case 1:
      ray.direction[random.between(0, 2)] = bad;
      break;
    case 2:
      ray.direction = glm::vec3(0.0f, -0.0f, random.one_in(2) ? 0.0f : -0.0f);
      break;
    default:
      (random.one_in(2) ? ray.tmin : ray.tmax) = kNan;
      break;
  }
  return ray;
}

struct RayKind {
  std::string_view name;
  Ray (*make)(Random&, Targets&);
};

constexpr RayKind kKinds[] = {
    {"at_vertex", at_vertex},       {"at_edge", at_edge},
    {"at_inside", at_inside},       {"along_edge", along_edge},
    {"in_plane", in_plane},         {"axis_parallel", axis_parallel},
    {"from_vertex", from_vertex},   {"from_edge", from_edge},
    {"from_surface", from_surface}, {"from_near_surface", from_near_surface},
    {"from_zero", from_zero},       {"at_midpoint", at_midpoint},
    {"from_afar", from_afar},       {"anywhere", anywhere},
    {"not_a_ray", not_a_ray},
};

// ---- What may be done to any ray.

// Another length, often at either end of the floats' range; what is lost there is part of the game.
void stretch(Random& random, glm::vec3& direction) {
  const float size = greatest(direction);
  if (!std::isfinite(size) || size == 0.0f) return;
  const int exponent = random.one_in(3)   ? random.between(-149, -125)
                       : random.one_in(2) ? random.between(110, 127)
                                          : random.between(-40, 40);
  for (int axis = 0; axis < 3; ++axis)
    direction[axis] = std::ldexp(direction[axis], exponent - std::ilogb(size));
}

// tmin and tmax: at the depth of the triangle aimed at, one or two floats beside it, or odd on their own.
void limit(Random& random, const Targets& targets, Ray& ray) {
  const float t = targets.depth(ray);
  const auto near_t = [&] { return std::isfinite(t) ? nudged(random, t, random.between(0, 2)) : 1.0f; };
  switch (random.below(6)) {
    case 0:
      ray.tmax = near_t();
      break;
    case 1:
      ray.tmin = near_t();
      break;
    case 2:
      ray.tmin = near_t();
      ray.tmax = near_t();
      break;
    case 3:
      ray.tmin = random.one_in(2) ? -kInf : -std::fabs(near_t());
      break;
    case 4:
      ray.tmax = 2.0f * near_t();
      break;
    default: {
      float& end = random.one_in(2) ? ray.tmin : ray.tmax;
      end = random.pick(std::vector<float>{0.0f, -0.0f, kInf, -kInf, 0x1p-149f});
      break;
    }
  }
}

Ray make_ray(Random& random, Targets& targets, const RayKind& kind) {
  targets.choose();
  Ray ray = kind.make(random, targets);
  if (random.one_in(8)) ray.direction = -ray.direction;
  if (random.one_in(4)) stretch(random, ray.direction);
  if (random.one_in(5)) {
    glm::vec3& nudge = random.one_in(2) ? ray.origin : ray.direction;
    const int axis = random.between(0, 2);
    if (std::isfinite(nudge[axis])) nudge[axis] = nudged(random, nudge[axis], 1);
  }
  if (!std::isnan(ray.tmin) && !std::isnan(ray.tmax) && random.one_in(3)) limit(random, targets, ray);
  return ray;
}

}  // namespace

std::string Case::describe(std::size_t i) const {
  const Ray& r = rays[i];
  char text[400];
  std::snprintf(text, sizeof text, "%s, seed %llu, ray %zu (%s): o %a %a %a d %a %a %a tmin %a tmax %a",
                std::string(scene).c_str(), static_cast<unsigned long long>(seed), i,
                std::string(ray_kinds[i]).c_str(), double{r.origin.x}, double{r.origin.y}, double{r.origin.z},
                double{r.direction.x}, double{r.direction.y}, double{r.direction.z}, double{r.tmin},
                double{r.tmax});
  return text;
}

Case make_case(const SceneKind& scene, std::uint64_t seed, std::size_t ray_count) {
  Random random(seed);
  Case result{scene.name, seed, scene.make(random), {}, {}};
  Targets targets(random, result.mesh);
  for (std::size_t i = 0; i < ray_count; ++i) {
    const RayKind& kind = kKinds[random.below(std::size(kKinds))];
    result.rays.push_back(make_ray(random, targets, kind));
    result.ray_kinds.push_back(kind.name);
  }
  return result;
}

Ray ray_of_kind(Random& random, const TriangleMesh& mesh, std::string_view kind) {
  Targets targets(random, mesh);
  return kind_called(kKinds, kind).make(random, targets);
}

std::vector<Case> make_cases(std::uint64_t seeds, std::size_t ray_count) {
  std::vector<Case> cases;
  for (const SceneKind& scene : scene_kinds()) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) cases.push_back(make_case(scene, seed, ray_count));
  }
  return cases;
}

}  // namespace plumb::hard
