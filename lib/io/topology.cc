#include "plumb/topology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/mesh_check.h"
#include "io/cover.h"
#include "io/degenerate.h"
#include "io/disjoint_sets.h"
#include "io/half_edges.h"
#include "plumb/error.h"

// OpenMesh's half-edges can only hold a surface that is everywhere a disk or half a disk with one
// orientation, and refuse what is not. So edges are first matched by sorting; about each position the corners
// that edges of exactly two triangles join are collected into fans; and each fan becomes a vertex of
// OpenMesh's. Where triangles disagree which side is the front, io/cover.h helps.

namespace plumb {
namespace {

using detail::Corners;

constexpr std::size_t kMostTriangles = 150'000'000;  // OpenMesh counts half-edges in an int, twelve for each

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

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

/// The triangles that count.
struct Kept {
  std::vector<Corners> triangles;  // by their positions' first vertices
  std::vector<std::uint32_t> ids;  // in the mesh
};

Kept kept_triangles(MeshView mesh, const std::vector<std::uint32_t>& first, Topology& result) {
  Kept kept;
  kept.triangles.reserve(mesh.triangles.size());
  kept.ids.reserve(mesh.triangles.size());
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const glm::uvec3& t = mesh.triangles[id];
    const detail::Triangle triangle{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (!is_finite(triangle.v0) || !is_finite(triangle.v1) || !is_finite(triangle.v2)) {
      ++result.non_finite;
      continue;
    }
    const Corners c{first[t.x], first[t.y], first[t.z]};
    const bool collapsed = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    result.collapsed += collapsed ? 1 : 0;
    result.degenerate += collapsed || detail::has_no_area(triangle) ? 1 : 0;
    if (collapsed) continue;
    kept.triangles.push_back(c);
    kept.ids.push_back(id);
  }
  result.triangles = kept.triangles.size();
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

/// For each side the one other that shares its edge, or kNoMate. Counts edges, parts and what cannot be
/// joined.
std::vector<std::uint32_t> match_sides(const Kept& kept, Topology& result) {
  const std::vector<Side> sides = sorted_sides(kept.triangles);
  std::vector<std::uint32_t> mates(sides.size(), detail::kNoMate);
  std::vector<bool> unjoined(kept.triangles.size(), false);
  detail::DisjointSets parts(kept.triangles.size());
  result.components = kept.triangles.size();
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const Side& a = sides[begin];
    for (end = begin + 1; end < sides.size() && sides[end].low == a.low && sides[end].high == a.high; ++end) {
      if (parts.join(a.corner / 3, sides[end].corner / 3)) --result.components;
    }
    const std::size_t count = end - begin;
    const bool is_turned = count == 2 && a.rises == sides[begin + 1].rises;
    ++result.edges;
    result.boundary_edges += count == 1 ? 1 : 0;
    result.non_manifold_edges += count > 2 ? 1 : 0;
    result.odd_edges += count % 2;
    result.turned_edges += is_turned ? 1 : 0;
    if (count == 2) {
      mates[a.corner] = sides[begin + 1].corner;
      mates[sides[begin + 1].corner] = a.corner;
    }
    if (count == 2 && !is_turned) continue;
    for (std::size_t i = begin; count > 1 && i < end; ++i) unjoined[sides[i].corner / 3] = true;
  }
  for (std::size_t i = 0; i < unjoined.size(); ++i) {
    if (!unjoined[i]) continue;
    ++result.unjoined_triangles;
    if (result.first_unjoined.size() < Topology::kMaxListed) result.first_unjoined.push_back(kept.ids[i]);
  }
  return mates;
}

/// Counts positions, and those with several fans.
void count_fans(const detail::Cover& cover, detail::DisjointSets& fans, std::size_t vertices,
                Topology& result) {
  std::vector<std::uint32_t> fans_at(vertices, 0);
  for (std::uint32_t corner = 0; corner < cover.mates().size(); ++corner) {
    if (fans.find(corner) == corner) ++fans_at[cover.position(corner)];
  }
  for (const std::uint32_t count : fans_at) {
    result.positions += count != 0 ? 1 : 0;
    result.non_manifold_positions += count > cover.sheets() ? 1 : 0;
  }
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
  const Kept kept = kept_triangles(mesh, first, result);
  result.duplicates = count_duplicates(kept.triangles);
  step();
  std::vector<std::uint32_t> mates = match_sides(kept, result);
  step();
  const detail::Cover cover(kept.triangles, std::move(mates), result.turned_edges != 0);
  detail::DisjointSets fans = cover.fans();
  count_fans(cover, fans, mesh.positions.size(), result);
  step();
  const detail::SurfaceCounts counts = detail::count_surface(cover, fans);
  result.boundary_loops = counts.boundary_loops;
  result.euler_characteristic = counts.euler_characteristic;
  step();
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
