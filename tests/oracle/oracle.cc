#include "oracle/oracle.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "oracle/exact.h"

namespace oracle {
namespace {

// Integers of 2^-149 each; the products below count in powers of that unit.
struct Integer3 {
  mpz_class x, y, z;
};

Integer3 integers(const Vec3& v) { return {scaled(v.x), scaled(v.y), scaled(v.z)}; }

Integer3 operator-(const Integer3& p, const Integer3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

Integer3 cross(const Integer3& p, const Integer3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

mpz_class dot(const Integer3& p, const Integer3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// The sign of d . n along the direction d + (e, e^2, e^3).
int displaced_sign(const Integer3& d, const Integer3& n) {
  for (const int sign : {sgn(dot(d, n)), sgn(n.x), sgn(n.y), sgn(n.z)}) {
    if (sign != 0) return sign;
  }
  return 0;
}

// One line and one triangle: the definition's names.
struct Meeting {
  Integer3 d, a, b, c;

  Meeting(const Vec3& origin, const Vec3& direction, const Triangle& triangle) : d(integers(direction)) {
    const Integer3 o = integers(origin);
    a = integers(triangle.v0) - o;
    b = integers(triangle.v1) - o;
    c = integers(triangle.v2) - o;
  }

  bool covered() const {
    const int sign = displaced_sign(d, cross(a, b));
    return sign != 0 && displaced_sign(d, cross(b, c)) == sign && displaced_sign(d, cross(c, a)) == sign;
  }

  // The numerator counts in unit^3 and so does the denominator: the unit cancels.
  std::optional<float> depth() const {
    const mpz_class denominator = dot(d, cross(a, b)) + dot(d, cross(b, c)) + dot(d, cross(c, a));
    if (denominator == 0) return std::nullopt;
    return nearest_float(dot(a, cross(b, c)), denominator);
  }
};

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool counts(const Ray& ray, float t) { return std::max(ray.tmin, 0.0f) < t && t <= ray.tmax; }

bool before(const Hit& a, const Hit& b) { return std::tie(a.t, a.id) < std::tie(b.t, b.id); }

}  // namespace

bool can_see(const Ray& ray) {
  const Vec3& d = ray.direction;
  return is_finite(ray.origin) && is_finite(d) && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f) &&
         !std::isnan(ray.tmin) && !std::isnan(ray.tmax);
}

bool can_be_seen(const Triangle& triangle) {
  return is_finite(triangle.v0) && is_finite(triangle.v1) && is_finite(triangle.v2);
}

bool line_meets(const Vec3& origin, const Vec3& direction, const Triangle& triangle) {
  return Meeting(origin, direction, triangle).covered();
}

std::optional<float> line_hit(const Vec3& origin, const Vec3& direction, const Triangle& triangle) {
  const Meeting meeting(origin, direction, triangle);
  if (!meeting.covered()) return std::nullopt;
  const std::optional<float> t = meeting.depth();
  return t && std::isfinite(*t) ? t : std::nullopt;
}

std::optional<float> plane_depth(const Vec3& origin, const Vec3& direction, const Triangle& triangle) {
  return Meeting(origin, direction, triangle).depth();
}

Scene::Scene(std::vector<Triangle> triangles, Filter filter) : triangles_(std::move(triangles)) {
  std::erase_if(triangles_, [](const Triangle& triangle) { return !can_be_seen(triangle); });
  if (filter == Filter::kPrefilter) prefilter_.emplace(triangles_);
}

std::vector<Hit> Scene::all(const Ray& ray) const {
  std::vector<Hit> hits;
  if (!can_see(ray)) return hits;
  const auto test = [&](const Triangle& triangle) {
    const std::optional<float> t = line_hit(ray.origin, ray.direction, triangle);
    if (t && counts(ray, *t)) hits.push_back({*t, triangle.id});
  };
  if (prefilter_) {
    for (const std::size_t i : prefilter_->candidates(ray)) test(triangles_[i]);
  } else {
    for (const Triangle& triangle : triangles_) test(triangle);
  }
  std::sort(hits.begin(), hits.end(), before);
  return hits;
}

Hit Scene::closest(const Ray& ray) const {
  const std::vector<Hit> hits = all(ray);
  return hits.empty() ? Hit{} : hits.front();
}

bool Scene::any(const Ray& ray) const { return !all(ray).empty(); }

Frame render(const Scene& scene, const Camera& camera) {
  Frame frame{camera.width, camera.height, {}};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) frame.pixels.push_back(scene.closest(camera.ray(x, y)));
  }
  return frame;
}

}  // namespace oracle
