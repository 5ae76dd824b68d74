#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "base/round.h"
#include "plumb/mesh.h"

// What the built-in scenes are made with. A scene is the same bits on every machine, so its
// coordinates come from integers and from + - * / and sqrt of doubles alone, rounded to float once, at
// the end; the C library's functions differ from one machine to the next.

namespace plumb::detail {

/// The double rounded to a float vertex.
inline glm::vec3 to_vertex(const glm::dvec3& p) {
  return {round_to_float(p.x), round_to_float(p.y), round_to_float(p.z)};
}

/// Appends a vertex; returns its index.
inline std::uint32_t append_vertex(TriangleMesh& mesh, const glm::dvec3& p) {
  mesh.positions.push_back(to_vertex(p));
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// Appends the two triangles of a quad given by the indices of its corners, in order around it.
inline void append_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                        std::uint32_t d) {
  mesh.triangles.emplace_back(a, b, c);
  mesh.triangles.emplace_back(a, c, d);
}

/// The same with new vertices.
inline void append_quad(TriangleMesh& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                        const glm::dvec3& d) {
  const std::uint32_t first = append_vertex(mesh, a);
  append_vertex(mesh, b);
  append_vertex(mesh, c);
  append_vertex(mesh, d);
  append_quad(mesh, first, first + 1, first + 2, first + 3);
}

/// 32 well mixed bits of two numbers and a seed. The mixer's constants are those of MurmurHash3's
/// finalizer (Austin Appleby, public domain).
inline std::uint32_t hash_bits(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  const auto mix = [](std::uint32_t h) {
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
  };
  return mix(x + 0x9e3779b9u * mix(y + 0x9e3779b9u * mix(seed)));
}

/// The same as a number from 0 to 1 (excluded), with 24 bits.
inline double hash_unit(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  return (hash_bits(x, y, seed) >> 8) * 0x1p-24;
}

/// Cosine and sine of an angle.
struct Turn {
  double cos, sin;
};

/// Of 2 pi `share`, by the Taylor series about the nearest quarter turn: 16 digits within the eighth
/// of a turn that is left on either side.
Turn turn(double share);

}  // namespace plumb::detail
