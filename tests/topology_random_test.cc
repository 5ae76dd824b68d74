#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "plumb/topology.h"
#include "support/effort.h"
#include "support/random.h"

// What topology() counts on half-edges, counted on graphs instead: slowly, and without a double cover.

using namespace plumb;
using hard::Random;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Corner = std::pair<std::size_t, std::uint32_t>;  // a triangle and one of its vertices

template <typename Node>
class Graph {
 public:
  void add(const Node& node) { neighbours_[node]; }
  void join(const Node& a, const Node& b) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }
  // For each node the number of its part.
  std::map<Node, std::size_t> parts() const {
    std::map<Node, std::size_t> part;
    std::size_t count = 0;
    for (const auto& [start, ignored] : neighbours_) {
      if (part.count(start) != 0) continue;
      std::vector<Node> open = {start};
      part[start] = count;
      while (!open.empty()) {
        const Node node = open.back();
        open.pop_back();
        for (const Node& next : neighbours_.at(node)) {
          if (part.emplace(next, count).second) open.push_back(next);
        }
      }
      ++count;
    }
    return part;
  }
  std::size_t count_parts() const {
    std::size_t count = 0;
    for (const auto& [node, part] : parts()) count = std::max(count, part + 1);
    return count;
  }

 private:
  std::map<Node, std::vector<Node>> neighbours_;
};

// Of a mesh whose triangles have three different positions each, no two vertices at one.
Topology on_graphs(const TriangleMesh& mesh) {
  Topology result;
  result.triangles = mesh.triangles.size();
  std::map<Edge, std::vector<std::pair<std::size_t, bool>>>
      edges;  // its triangles, and whether it rises there
  Graph<std::size_t> parts;
  Graph<Corner> fans;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    parts.add(i);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      edges[std::minmax(from, to)].emplace_back(i, from < to);
      fans.add({i, from});
    }
  }
  result.edges = edges.size();
  std::size_t edges_apart = 0;
  std::vector<std::pair<Corner, Corner>> rims;  // sides without a neighbour
  std::set<std::size_t> unjoined;
  for (const auto& [edge, triangles] : edges) {
    for (const auto& [triangle, rises] : triangles) parts.join(triangles[0].first, triangle);
    const bool pair = triangles.size() == 2;
    const bool turned = pair && triangles[0].second == triangles[1].second;
    result.boundary_edges += triangles.size() == 1 ? 1u : 0u;
    result.odd_edges += triangles.size() % 2;
    result.non_manifold_edges += triangles.size() > 2 ? 1u : 0u;
    result.turned_edges += turned ? 1u : 0u;
    edges_apart += pair ? 1u : triangles.size();
    for (const auto& [triangle, rises] : triangles) {
      if (triangles.size() > 2 || turned) unjoined.insert(triangle);
      if (!pair) rims.push_back({{triangle, edge.first}, {triangle, edge.second}});
    }
    if (!pair) continue;
    for (const std::uint32_t vertex : {edge.first, edge.second}) {
      fans.join({triangles[0].first, vertex}, {triangles[1].first, vertex});
    }
  }
  const std::map<Corner, std::size_t> fan_of = fans.parts();
  std::map<std::uint32_t, std::set<std::size_t>> fans_at;
  for (const auto& [corner, fan] : fan_of) fans_at[corner.second].insert(fan);
  for (const auto& [vertex, set] : fans_at) result.non_manifold_positions += set.size() > 1 ? 1u : 0u;
  Graph<std::size_t> boundary;
  for (const auto& [a, b] : rims) boundary.join(fan_of.at(a), fan_of.at(b));
  result.positions = fans_at.size();
  result.unjoined_triangles = unjoined.size();
  result.components = parts.count_parts();
  result.boundary_loops = boundary.count_parts();
  result.euler_characteristic = static_cast<std::ptrdiff_t>(fans.count_parts() + mesh.triangles.size()) -
                                static_cast<std::ptrdiff_t>(edges_apart);
  return result;
}

// Random triangles over few positions: mostly nothing that OpenMesh would take.
TriangleMesh tangle(Random& random) {
  TriangleMesh mesh;
  const auto vertices = static_cast<std::uint32_t>(random.between(3, 12));
  for (std::uint32_t i = 0; i < vertices; ++i) mesh.positions.emplace_back(i, i * i, 0);
  for (int i = random.between(1, 24); i > 0; --i) {
    const glm::uvec3 t(random.below(vertices), random.below(vertices), random.below(vertices));
    if (t.x != t.y && t.y != t.z && t.z != t.x) mesh.triangles.push_back(t);
  }
  return mesh;
}

// A grid whose opposite sides may be one, either way round, with holes, and some triangles turned over.
TriangleMesh sheet(Random& random) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(random.between(3, 6));
  const bool joins = random.one_in(2), turns = random.one_in(2), joins_too = random.one_in(2);
  for (std::uint32_t i = 0; i < (n + 1) * (n + 1); ++i) mesh.positions.emplace_back(i, i * i, 0);
  const auto vertex = [&](std::uint32_t x, std::uint32_t y) {
    if (joins && x == n) {
      x = 0;
      y = turns ? n - y : y;
    }
    if (joins_too && y == n) y = 0;
    return x * (n + 1) + y;
  };
  const std::uint32_t holes = random.one_in(2) ? 8 : 1000, turned = random.one_in(2) ? 4 : 1000;
  const auto add = [&](glm::uvec3 t) {
    if (random.one_in(turned)) std::swap(t.x, t.y);
    if (!random.one_in(holes)) mesh.triangles.push_back(t);
  };
  for (std::uint32_t x = 0; x < n; ++x) {
    for (std::uint32_t y = 0; y < n; ++y) {
      add({vertex(x, y), vertex(x + 1, y), vertex(x, y + 1)});
      add({vertex(x, y + 1), vertex(x + 1, y), vertex(x + 1, y + 1)});
    }
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

void check_equal(const Topology& t, const Topology& expected) {
  CHECK(t.positions == expected.positions);
  CHECK(t.triangles == expected.triangles);
  CHECK(t.edges == expected.edges);
  CHECK(t.boundary_edges == expected.boundary_edges);
  CHECK(t.odd_edges == expected.odd_edges);
  CHECK(t.non_manifold_edges == expected.non_manifold_edges);
  CHECK(t.turned_edges == expected.turned_edges);
  CHECK(t.non_manifold_positions == expected.non_manifold_positions);
  CHECK(t.unjoined_triangles == expected.unjoined_triangles);
  CHECK(t.components == expected.components);
  CHECK(t.boundary_loops == expected.boundary_loops);
  CHECK(t.euler_characteristic == expected.euler_characteristic);
}

}  // namespace

TEST_SUITE("topology of random meshes") {
  TEST_CASE("of tangles is what is counted on graphs") {
    Random random(1);
    for (int i = 0; i < hard::effort(4000); ++i) {
      CAPTURE(i);
      const TriangleMesh mesh = tangle(random);
      check_equal(topology(mesh), on_graphs(mesh));
    }
  }

  TEST_CASE("of sheets, rings, tori, Moebius bands and Klein bottles with holes and turned faces, too") {
    Random random(2);
    int manifold = 0, turned = 0;
    for (int i = 0; i < hard::effort(2000); ++i) {
      CAPTURE(i);
      const TriangleMesh mesh = sheet(random);
      const Topology t = topology(mesh);
      check_equal(t, on_graphs(mesh));
      manifold += t.manifold() ? 1 : 0;
      turned += t.turned_edges != 0 ? 1 : 0;
    }
    CHECK(manifold > hard::effort(500));
    CHECK(turned > hard::effort(500));
  }
}
