#include "io/half_edges.h"

#include <cstdint>
#include <span>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

// OpenMesh's add_face() looks for each side among all edges of a vertex, which takes n^2 time where n
// triangles meet, prints what it refuses, and may fail to relink what came in an unlucky order. All that it
// would find out is known here, so the half-edges are linked directly, in n time.

namespace plumb::detail {
namespace {

using HalfEdges = OpenMesh::TriConnectivity;

std::size_t index_of(HalfEdges::HalfedgeHandle side) { return static_cast<std::size_t>(side.idx()); }

/// A vertex for each set of corners, at the corner that stands for it.
std::vector<HalfEdges::VertexHandle> add_vertices(HalfEdges& surface, std::size_t corners,
                                                  DisjointSets& fans) {
  std::vector<HalfEdges::VertexHandle> vertex_of(corners);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    if (fans.find(corner) == corner) vertex_of[corner] = surface.new_vertex();
  }
  return vertex_of;
}

/// Adds a triangle's half-edges, or finds those that its mates' edges brought, and links them around it.
void add_triangle(HalfEdges& surface, std::uint32_t first, std::span<const std::uint32_t> mates,
                  const HalfEdges::VertexHandle (&vertices)[3],
                  std::vector<HalfEdges::HalfedgeHandle>& sides) {
  const HalfEdges::FaceHandle face = surface.new_face();
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t mate = mates[first + k];
    HalfEdges::HalfedgeHandle& side = sides[first + k];
    side = mate < first ? surface.opposite_halfedge_handle(sides[mate])
                        : surface.new_edge(vertices[k], vertices[(k + 1) % 3]);
    surface.set_face_handle(side, face);
    surface.set_halfedge_handle(vertices[k], side);
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    surface.set_next_halfedge_handle(sides[first + k], sides[first + (k + 1) % 3]);
  }
  surface.set_halfedge_handle(face, sides[first]);
}

/// Links the half-edges outside. At most one leaves a vertex, for its corners are one fan or ring; it is
/// the one that OpenMesh wants a vertex to know.
void link_boundary(HalfEdges& surface) {
  for (const auto side : surface.halfedges()) {
    if (surface.is_boundary(side)) surface.set_halfedge_handle(surface.from_vertex_handle(side), side);
  }
  for (const auto side : surface.halfedges()) {
    if (!surface.is_boundary(side)) continue;
    surface.set_next_halfedge_handle(side, surface.halfedge_handle(surface.to_vertex_handle(side)));
  }
}

HalfEdges link(std::span<const std::uint32_t> mates, DisjointSets& fans) {
  HalfEdges surface;
  const std::size_t triangles = mates.size() / 3;
  surface.reserve(triangles / 2 + 3, mates.size() / 2 + 3, triangles);
  const std::vector<HalfEdges::VertexHandle> vertex_of = add_vertices(surface, mates.size(), fans);
  std::vector<HalfEdges::HalfedgeHandle> sides(mates.size());
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const std::uint32_t first = 3 * i;
    const HalfEdges::VertexHandle vertices[3] = {vertex_of[fans.find(first)], vertex_of[fans.find(first + 1)],
                                                 vertex_of[fans.find(first + 2)]};
    add_triangle(surface, first, mates, vertices, sides);
  }
  link_boundary(surface);
  return surface;
}

std::size_t count_boundary_loops(const HalfEdges& surface) {
  std::vector<bool> seen(surface.n_halfedges(), false);
  std::size_t loops = 0;
  for (const auto start : surface.halfedges()) {
    if (!surface.is_boundary(start) || seen[index_of(start)]) continue;
    ++loops;
    for (HalfEdges::HalfedgeHandle at = start; !seen[index_of(at)]; at = surface.next_halfedge_handle(at)) {
      seen[index_of(at)] = true;
    }
  }
  return loops;
}

}  // namespace

SurfaceCounts count_surface(const Cover& cover, DisjointSets& fans) {
  const HalfEdges surface = link(cover.mates(), fans);
  const auto sheets = static_cast<std::ptrdiff_t>(cover.sheets());
  const auto characteristic = static_cast<std::ptrdiff_t>(surface.n_vertices() + surface.n_faces()) -
                              static_cast<std::ptrdiff_t>(surface.n_edges());
  return {count_boundary_loops(surface) / cover.sheets(), characteristic / sheets};
}

}  // namespace plumb::detail
