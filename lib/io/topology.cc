#include "plumb/topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/mesh_check.h"
#include "io/degenerate.h"
#include "plumb/error.h"

// OpenMesh's half-edges can only hold a surface that is everywhere a disk or half a disk with one
// orientation, and refuse (and print) what is not. So edges are first matched by sorting; about each position
// the corners that edges of exactly two triangles join are collected into fans; and each fan becomes a vertex
// of OpenMesh's. What remains cut is what cannot be joined.

namespace plumb {
namespace {

using Corners = std::array<std::uint32_t, 3>;

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Disjoint sets of corners (Galler and Fischer 1964), with path halving.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each vertex the first one at the same position.
std::vector<std::uint32_t> first_at_position(MeshView mesh) {
  // + 0 turns -0 into +0.
  const auto key = [&](std::uint32_t i) {
    const glm::vec3& p = mesh.positions[i];
    return std::tuple(p.x + 0.0f, p.y + 0.0f, p.z + 0.0f);
  };
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_finite(mesh.positions[i])) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<std::uint32_t> first(mesh.positions.size());
  std::iota(first.begin(), first.end(), 0u);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) first[order[i]] = first[order[i - 1]];
  }
  return first;
}

void count_vertices(MeshView mesh, const std::vector<std::uint32_t>& first, Topology& result) {
  std::vector<bool> used(mesh.positions.size(), false), seen(mesh.positions.size(), false);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) used[t[k]] = true;
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) {
      ++result.unused_vertices;
    } else if (seen[first[i]]) {
      ++result.repeated_vertices;
    } else {
      seen[first[i]] = true;
    }
  }
}

/// The triangles that count, by their positions' first vertices.
std::vector<Corners> kept_triangles(MeshView mesh, const std::vector<std::uint32_t>& first,
                                    Topology& result) {
  std::vector<Corners> kept;
  kept.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) {
    const detail::Triangle triangle{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (!is_finite(triangle.v0) || !is_finite(triangle.v1) || !is_finite(triangle.v2)) {
      ++result.non_finite;
      continue;
    }
    const Corners c{first[t.x], first[t.y], first[t.z]};
    const bool collapsed = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    result.collapsed += collapsed ? 1 : 0;
    result.degenerate += collapsed || detail::has_no_area(triangle) ? 1 : 0;
    if (!collapsed) kept.push_back(c);
  }
  result.triangles = kept.size();
  return kept;
}

std::size_t count_duplicates(std::vector<Corners> triangles) {
  for (Corners& c : triangles) std::sort(c.begin(), c.end());
  std::sort(triangles.begin(), triangles.end());
  const auto different = std::unique(triangles.begin(), triangles.end()) - triangles.begin();
  return triangles.size() - static_cast<std::size_t>(different);
}

/// A triangle's side from one of its corners to the next.
struct Side {
  std::uint32_t low, high;  // positions
  std::uint32_t corner;     // 3 * triangle + k
  bool rises;               // from low to high
};

std::vector<Side> sorted_sides(const std::vector<Corners>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[i][k], to = triangles[i][(k + 1) % 3];
      sides.push_back(
          {std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(3 * i + k), from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return sides;
}

std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// Counts the edges, and joins the corners at the ends of those that two triangles share as neighbours do.
void match_sides(const std::vector<Side>& sides, Sets& fans, Topology& result) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high)
      ++end;
    const std::size_t count = end - begin;
    ++result.edges;
    result.boundary_edges += count == 1 ? 1 : 0;
    result.non_manifold_edges += count > 2 ? 1 : 0;
    result.odd_edges += count % 2;
    if (count != 2) continue;
    const Side& a = sides[begin];
    const Side& b = sides[begin + 1];
    if (a.rises == b.rises) {
      ++result.turned_edges;
      continue;
    }
    fans.join(a.corner, next_corner(b.corner));
    fans.join(next_corner(a.corner), b.corner);
  }
}

/// Counts positions, and those with several fans.
void count_fans(const std::vector<Corners>& triangles, Sets& fans, std::size_t vertices, Topology& result) {
  constexpr std::uint32_t kNoFan = 0xffffffffu;
  std::vector<std::uint32_t> fan_at(vertices, kNoFan);
  std::vector<bool> several(vertices, false);
  for (std::uint32_t corner = 0; corner < 3 * triangles.size(); ++corner) {
    const std::uint32_t position = triangles[corner / 3][corner % 3];
    const std::uint32_t fan = fans.find(corner);
    if (fan_at[position] == kNoFan) ++result.positions;
    if (fan_at[position] != kNoFan && fan_at[position] != fan) several[position] = true;
    fan_at[position] = fan;
  }
  result.non_manifold_positions = static_cast<std::size_t>(std::count(several.begin(), several.end(), true));
}

using HalfEdges = OpenMesh::TriConnectivity;
constexpr std::size_t kMostTriangles = 300'000'000;  // OpenMesh counts half-edges in an int
constexpr std::uint32_t kReport = 4096;              // triangles between two calls of progress

/// The triangles with a vertex for each fan. One whose side is there already, on the same side of the
/// surface, gets vertices of its own: OpenMesh would refuse it.
HalfEdges half_edges(const std::vector<Corners>& triangles, Sets& fans, detail::Progress& progress) {
  HalfEdges surface;
  surface.reserve(triangles.size() / 2 + 3, 3 * triangles.size() / 2 + 3, triangles.size());
  std::vector<HalfEdges::VertexHandle> vertex_of(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    HalfEdges::VertexHandle corners[3];
    for (std::uint32_t k = 0; k < 3; ++k) {
      HalfEdges::VertexHandle& vertex = vertex_of[fans.find(3 * i + k)];
      if (!vertex.is_valid()) vertex = surface.new_vertex();
      corners[k] = vertex;
    }
    bool is_free = true;
    for (int k = 0; k < 3; ++k) {
      const HalfEdges::HalfedgeHandle side = surface.find_halfedge(corners[k], corners[(k + 1) % 3]);
      is_free = is_free && (!side.is_valid() || surface.is_boundary(side));
    }
    for (HalfEdges::VertexHandle& corner : corners) {
      if (!is_free) corner = surface.new_vertex();
    }
    surface.add_face(corners, 3);
    if (i % kReport == kReport - 1) {
      progress.add(kReport);
      progress.throw_if_cancelled();
    }
  }
  return surface;
}

std::size_t count_components(const HalfEdges& surface) {
  Sets sets(surface.n_faces());
  std::size_t count = surface.n_faces();
  for (const auto edge : surface.edges()) {
    const HalfEdges::FaceHandle a = surface.face_handle(surface.halfedge_handle(edge, 0));
    const HalfEdges::FaceHandle b = surface.face_handle(surface.halfedge_handle(edge, 1));
    if (!a.is_valid() || !b.is_valid()) continue;
    const std::uint32_t x = sets.find(static_cast<std::uint32_t>(a.idx()));
    const std::uint32_t y = sets.find(static_cast<std::uint32_t>(b.idx()));
    if (x == y) continue;
    sets.join(x, y);
    --count;
  }
  return count;
}

std::size_t count_boundary_loops(const HalfEdges& surface) {
  std::vector<bool> seen(surface.n_halfedges(), false);
  std::size_t loops = 0;
  for (const auto start : surface.halfedges()) {
    if (!surface.is_boundary(start) || seen[static_cast<std::size_t>(start.idx())]) continue;
    ++loops;
    for (HalfEdges::HalfedgeHandle at = start; !seen[static_cast<std::size_t>(at.idx())];
         at = surface.next_halfedge_handle(at)) {
      seen[static_cast<std::size_t>(at.idx())] = true;
    }
  }
  return loops;
}

/// Vertices that belong to a triangle: a fan whose triangles all got vertices of their own has none.
std::size_t count_used_vertices(const HalfEdges& surface) {
  std::size_t count = 0;
  for (const auto vertex : surface.vertices()) count += surface.is_isolated(vertex) ? 0u : 1u;
  return count;
}

Topology analyse(MeshView mesh, const std::function<bool(double)>& progress_call) {
  Topology result;
  detail::Progress progress(progress_call, 5 * mesh.triangles.size());
  const auto step = [&] {
    progress.add(mesh.triangles.size());
    progress.throw_if_cancelled();
  };
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  count_vertices(mesh, first, result);
  step();
  const std::vector<Corners> triangles = kept_triangles(mesh, first, result);
  result.duplicates = count_duplicates(triangles);
  step();
  Sets fans(3 * triangles.size());
  match_sides(sorted_sides(triangles), fans, result);
  step();
  count_fans(triangles, fans, mesh.positions.size(), result);
  step();
  const HalfEdges surface = half_edges(triangles, fans, progress);
  result.components = count_components(surface);
  result.boundary_loops = count_boundary_loops(surface);
  result.euler_characteristic =
      static_cast<std::ptrdiff_t>(count_used_vertices(surface) + surface.n_faces()) -
      static_cast<std::ptrdiff_t>(surface.n_edges());
  return result;
}

}  // namespace

Topology topology(MeshView mesh, const std::function<bool(double)>& progress) {
  detail::check_mesh(mesh, 0, "topology");
  if (mesh.triangles.size() > kMostTriangles) {
    throw Error("plumb: topology of " + std::to_string(mesh.triangles.size()) +
                " triangles; it takes at most " + std::to_string(kMostTriangles));
  }
  return detail::with_default_fp_mode([&] { return analyse(mesh, progress); });
}

}  // namespace plumb
