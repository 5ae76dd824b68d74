#include "soak/shrink.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace plumb::soak {
namespace {

using cases::Instance;

// Tries smaller instances; keeps those on which the subject still differs in the same query.
class Shrinker {
 public:
  Shrinker(const Instance& instance, const Difference& difference, const Subject& subject)
      : subject_(subject), best_(instance), difference_(difference) {}

  bool attempt(Instance instance) {
    Tally tally;
    const auto found = find_difference(instance, std::span(&subject_, 1), tally);
    if (!found.has_value() || found->query != difference_.query) return false;
    best_ = std::move(instance);
    difference_ = *found;
    return true;
  }

  const Instance& best() const { return best_; }
  const Difference& difference() const { return difference_; }

 private:
  const Subject& subject_;
  Instance best_;
  Difference difference_;
};

// Leaves out parts of a list of the instance, halves first, then ever smaller pieces.
template <typename Item>
void leave_out(Shrinker& shrinker, std::vector<Item>& (*list)(Instance&)) {
  Instance whole = shrinker.best();
  for (std::size_t piece = std::max<std::size_t>(1, list(whole).size() / 2);; piece = (piece + 1) / 2) {
    for (std::size_t begin = 0; begin < list(whole).size();) {
      Instance smaller = whole;
      std::vector<Item>& items = list(smaller);
      const std::size_t end = std::min(items.size(), begin + piece);
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin),
                  items.begin() + static_cast<std::ptrdiff_t>(end));
      if (shrinker.attempt(smaller)) {
        whole = shrinker.best();
      } else {
        begin = end;
      }
    }
    if (piece == 1) return;
  }
}

std::vector<Ray>& rays_of(Instance& instance) { return instance.rays; }
std::vector<glm::uvec3>& triangles_of(Instance& instance) { return instance.mesh.triangles; }

// Each triangle with corners of its own, so that none is changed along with another; unused ones go.
void separate(Shrinker& shrinker) {
  Instance instance = shrinker.best();
  TriangleMesh mesh;
  for (const glm::uvec3& t : instance.mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(instance.mesh.positions[t[k]]);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  instance.mesh = std::move(mesh);
  shrinker.attempt(std::move(instance));
}

// What a number may be replaced by, the simplest first.
std::vector<float> simpler(float value) {
  std::vector<float> candidates = {0.0f, 1.0f, -1.0f};
  if (std::isfinite(value) && value != 0.0f) {
    const int exponent = std::ilogb(value);
    for (const int bits : {0, 1, 2, 4, 8, 16}) {
      const float unit = std::ldexp(1.0f, std::max(exponent - bits, -149));
      candidates.push_back(std::round(value / unit) * unit);
    }
  }
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](float c) { return !std::isfinite(c) || c == value; }),
                   candidates.end());
  return candidates;
}

void simplify(Shrinker& shrinker, const std::function<float&(Instance&)>& number) {
  Instance instance = shrinker.best();
  for (const float candidate : simpler(number(instance))) {
    number(instance) = candidate;
    if (shrinker.attempt(instance)) return;
    instance = shrinker.best();
  }
}

void simplify_numbers(Shrinker& shrinker) {
  for (std::size_t i = 0; i < shrinker.best().mesh.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      simplify(shrinker, [=](Instance& instance) -> float& { return instance.mesh.positions[i][axis]; });
  }
  for (std::size_t i = 0; i < shrinker.best().rays.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      simplify(shrinker, [=](Instance& instance) -> float& { return instance.rays[i].origin[axis]; });
      simplify(shrinker, [=](Instance& instance) -> float& { return instance.rays[i].direction[axis]; });
    }
    Instance instance = shrinker.best();
    instance.rays[i].tmin = 0.0f;
    if (shrinker.attempt(instance)) instance = shrinker.best();
    instance.rays[i].tmax = std::numeric_limits<float>::infinity();
    shrinker.attempt(instance);
  }
}

}  // namespace

Shrunk shrink(const Instance& instance, const Difference& difference, std::span<const Subject> subjects) {
  const Subject& subject = subjects[difference.subject];
  Shrinker shrinker(instance, difference, subject);
  Instance smaller = instance;
  if (difference.query == Query::Frame) {
    smaller.rays.clear();
  } else {
    smaller.camera.reset();
  }
  shrinker.attempt(smaller);
  leave_out<Ray>(shrinker, rays_of);
  leave_out<glm::uvec3>(shrinker, triangles_of);
  separate(shrinker);
  simplify_numbers(shrinker);
  leave_out<glm::uvec3>(shrinker, triangles_of);
  separate(shrinker);
  simplify_numbers(shrinker);  // what one number allows another may depend on
  Shrunk result{shrinker.best(), shrinker.difference()};
  result.difference.subject = difference.subject;
  return result;
}

}  // namespace plumb::soak
