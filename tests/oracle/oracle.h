#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

// What is visible, decided in integers of any length straight from docs/visibility.md and by brute
// force. Slow and plain on purpose. Expects the default floating-point mode.

namespace oracle {

inline constexpr std::uint32_t kNone = 0xffffffffu;

struct Vec3 {
  float x, y, z;
};

struct DVec3 {
  double x, y, z;
};

struct Ray {
  Vec3 origin;
  float tmin;
  Vec3 direction;
  float tmax;
};

struct Triangle {
  Vec3 v0, v1, v2;
  std::uint32_t id;
};

struct Hit {
  float t = std::numeric_limits<float>::infinity();
  std::uint32_t id = kNone;

  friend bool operator==(const Hit&, const Hit&) = default;
};

/// No NaN, finite origin and direction, a direction that is not zero.
bool can_see(const Ray& ray);

/// All nine coordinates are finite.
bool can_be_seen(const Triangle& triangle);

/// Whether the displaced line meets the triangle. As below, the origin and direction must be finite, and
/// the triangle.
bool line_meets(const Vec3& origin, const Vec3& direction, const Triangle& triangle);

/// RN32(t) where the displaced line meets the triangle, the denominator is not zero and RN32(t) is
/// finite; of either sign.
std::optional<float> line_hit(const Vec3& origin, const Vec3& direction, const Triangle& triangle);

/// RN32(t) of the line's meeting with the triangle's plane, covered or not and maybe infinite; nothing
/// where the denominator is zero.
std::optional<float> plane_depth(const Vec3& origin, const Vec3& direction, const Triangle& triangle);

/// The triangles that can be seen at all, with a bounding hierarchy in their order that leaves out
/// what a line provably does not meet.
class Prefilter {
 public:
  explicit Prefilter(const std::vector<Triangle>& triangles);

  /// The indices, ascending, of all triangles but some that the ray's displaced line does not meet.
  std::vector<std::size_t> candidates(const Ray& ray) const;

 private:
  struct Box {
    Vec3 lo, hi;
  };
  class Line;

  void visit(const Line& line, std::size_t level, std::size_t index, std::vector<std::size_t>& found) const;

  const std::vector<Triangle>* triangles_;
  std::vector<std::vector<Box>> levels_;  // levels_[0][i] bounds triangles kFan*i..., and so on up
  float greatest_ = 0.0f;                 // |coordinate|
};

/// A scene and its answers. Triangles that cannot be seen are left out; ids are the triangles' own.
class Scene {
 public:
  enum class Filter { kPlain, kPrefilter };

  explicit Scene(std::vector<Triangle> triangles, Filter filter = Filter::kPrefilter);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Every hit that counts, sorted by (t, id).
  std::vector<Hit> all(const Ray& ray) const;
  Hit closest(const Ray& ray) const;
  bool any(const Ray& ray) const;

 private:
  std::vector<Triangle> triangles_;
  std::optional<Prefilter> prefilter_;
};

struct Camera {
  Vec3 eye;
  DVec3 corner, du, dv;
  int width, height;

  Ray ray(int x, int y) const;
};

/// Nothing where the definition calls the input an error.
std::optional<Camera> look_at(const Vec3& eye, const Vec3& target, const Vec3& up, double fov_y_degrees,
                              int width, int height);

/// Row-major from the top.
struct Frame {
  int width, height;
  std::vector<Hit> pixels;
};

Frame render(const Scene& scene, const Camera& camera);

}  // namespace oracle
