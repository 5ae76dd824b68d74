#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cases/cases.h"
#include "plumb/ray.h"
#include "soak/subject.h"

// Holds subjects against the oracle.

namespace plumb::soak {

/// What was asked.
enum class Query { Closest, Any, All, First, SpanClosest, SpanAny, Frame };

/// How many hits Query::First asks for.
inline constexpr std::size_t kFirst = 2;

/// An answer of a subject that is not the oracle's.
struct Difference {
  std::size_t subject;  ///< its index
  Query query;
  std::size_t place;  ///< the ray's index, or the pixel's
  std::string text;   ///< for people: what was seen, and what is to be seen
};

/// How much was compared.
struct Tally {
  std::uint64_t rays = 0;           ///< distinct rays, each asked of every structure in every query
  std::uint64_t hits = 0;           ///< of their closest hits, those that are there
  std::uint64_t frames = 0;         ///< distinct frames
  std::uint64_t pixels = 0;         ///< of those
  std::uint64_t ray_answers = 0;    ///< answers compared
  std::uint64_t pixel_answers = 0;  ///< pixels compared

  Tally& operator+=(const Tally& other);
};

/// Compares every subject's answers to every ray and of the frame, if there is a camera, with the
/// oracle's, and stops at the first that differs. Needs the default floating-point mode.
std::optional<Difference> find_difference(const cases::Instance& instance, std::span<const Subject> subjects,
                                          Tally& tally);

/// What the oracle says of one ray, smallest (t, id) first.
std::vector<Hit> exact_hits(const TriangleMesh& mesh, const Ray& ray);

}  // namespace plumb::soak
