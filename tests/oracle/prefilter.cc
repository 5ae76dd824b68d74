#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/oracle.h"

// What a line certainly does not meet, found in double.
//
// Take two axes i, j and the function
//
//     s(p) = d_i (p_j - o_j) - d_j (p_i - o_i),
//
// which is zero on the ray's line. If s > 0 at all three vertices, or s < 0 at all three, the line
// misses the triangle, and so does the displaced one: suppose its three edge functions had one sign.
// Then so they would for some small actual e, with d' = d + (e, e^2, e^3), small enough that s', the
// function s of d', keeps its three signs. The identity E1 a + E2 b + E0 c = det(a, b, c) d' says that
// the point w1 a + w2 b + w0 c, where w = E / (E0 + E1 + E2) > 0, lies on the displaced line. So s'
// is zero there; but s' is affine with no constant in a, b, c and has the same sign at all three.
//
// As computed, each difference, each product and the last difference is rounded once, so s is off by at
// most ((1 + u)^3 - 1) (|d_i| |p_j - o_j| + |d_j| |p_i - o_i|) < 6.01 u D R, where u = 2^-53, D is the
// greatest |component| of d and R = |o|_max + the scene's greatest |coordinate|. The slack of 8 u D R
// is 2^-50 D R, its own roundings included. Float inputs neither overflow nor underflow here: D >=
// 2^-149, and R is 0 only where s is 0.
//
// Boxes: s is affine, so where it has one strict sign in all corners it has it in every vertex inside.

namespace oracle {
namespace {

constexpr std::size_t kFan = 8;

std::array<float, 3> components(const Vec3& v) { return {v.x, v.y, v.z}; }

Vec3 least(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Vec3 greatest(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

float magnitude(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

}  // namespace

class Prefilter::Line {
 public:
  Line(const Ray& ray, float scene_greatest)
      : o_(components(ray.origin)),
        d_(components(ray.direction)),
        slack_(0x1p-50 * double{magnitude(ray.direction)} *
               (double{magnitude(ray.origin)} + double{scene_greatest})) {}

  bool certainly_misses(const Triangle& t) const {
    const std::array<float, 3> v0 = components(t.v0), v1 = components(t.v1), v2 = components(t.v2);
    return separates([&](std::size_t i, std::size_t j) {
      return std::array<double, 3>{side(v0[i], v0[j], i, j), side(v1[i], v1[j], i, j),
                                   side(v2[i], v2[j], i, j)};
    });
  }

  bool certainly_misses(const Box& box) const {
    const std::array<float, 3> lo = components(box.lo), hi = components(box.hi);
    return separates([&](std::size_t i, std::size_t j) {
      return std::array<double, 4>{side(lo[i], lo[j], i, j), side(lo[i], hi[j], i, j),
                                   side(hi[i], lo[j], i, j), side(hi[i], hi[j], i, j)};
    });
  }

 private:
  // s at a point whose coordinates on axes i and j are given.
  double side(float pi, float pj, std::size_t i, std::size_t j) const {
    return double{d_[i]} * (double{pj} - double{o_[j]}) - double{d_[j]} * (double{pi} - double{o_[i]});
  }

  // Whether on some pair of axes all of `sides(i, j)` are certainly positive, or certainly negative.
  template <typename Sides>
  bool separates(const Sides& sides) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto values = sides(i, (i + 1) % 3);
      const auto [min, max] = std::minmax_element(values.begin(), values.end());
      if (*min > slack_ || *max < -slack_) return true;
    }
    return false;
  }

  std::array<float, 3> o_, d_;
  double slack_;
};

Prefilter::Prefilter(const std::vector<Triangle>& triangles) : triangles_(&triangles) {
  std::vector<Box> boxes;
  for (const Triangle& t : triangles) {
    boxes.push_back({least(least(t.v0, t.v1), t.v2), greatest(greatest(t.v0, t.v1), t.v2)});
    greatest_ = std::max({greatest_, magnitude(boxes.back().lo), magnitude(boxes.back().hi)});
  }
  while (boxes.size() > 1) {
    std::vector<Box> parents;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (i % kFan == 0) parents.push_back(boxes[i]);
      Box& parent = parents.back();
      parent = {least(parent.lo, boxes[i].lo), greatest(parent.hi, boxes[i].hi)};
    }
    levels_.push_back(parents);
    boxes = std::move(parents);
  }
}

std::vector<std::size_t> Prefilter::candidates(const Ray& ray) const {
  std::vector<std::size_t> found;
  if (triangles_->empty()) return found;
  visit(Line(ray, greatest_), levels_.size(), 0, found);
  return found;
}

// `level` counts from the triangles, which are level 0, to the one box around all.
void Prefilter::visit(const Line& line, std::size_t level, std::size_t index,
                      std::vector<std::size_t>& found) const {
  if (level == 0) {
    if (!line.certainly_misses((*triangles_)[index])) found.push_back(index);
    return;
  }
  if (line.certainly_misses(levels_[level - 1][index])) return;
  const std::size_t below = level == 1 ? triangles_->size() : levels_[level - 2].size();
  for (std::size_t i = kFan * index; i < std::min(kFan * (index + 1), below); ++i) {
    visit(line, level - 1, i, found);
  }
}

}  // namespace oracle
