#include "plumb/kd_tree.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmpxx.h>
#include <oneapi/tbb/global_control.h>

#include "build_scenes.h"
#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "structures/kd_build.h"
#include "support/effort.h"
#include "support/hard_rays.h"

using namespace plumb;
using plumb::detail::Box;
using plumb::detail::KdNode;
using plumb::detail::KdTreeParts;
using plumb::hard::Random;

namespace {

KdTreeParts build(const TriangleMesh& mesh, const detail::KdBuildOptions& options = {}) {
  detail::Progress progress(nullptr, mesh.triangles.size());
  return detail::build_kd_tree(mesh, options, progress);
}

bool same(const KdTreeParts& a, const KdTreeParts& b) {
  return a.order == b.order && a.nodes.size() == b.nodes.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(KdNode)) == 0;
}

// ---- What must hold of every tree.

struct Walk {
  const KdTreeParts& tree;
  std::size_t triangles;
  std::size_t next_reference = 0;
  int deepest = 0;
  std::string fault;

  // Visits the node and all below it; the index behind these.
  std::uint32_t visit(std::uint32_t index, const Box& box, int depth) {
    deepest = std::max(deepest, depth);
    if (index >= tree.nodes.size()) {
      fault = "a node is missing";
      return index;
    }
    const KdNode& node = tree.nodes[index];
    if (node.is_leaf()) {
      check_leaf(node);
      return index + 1;
    }
    const int axis = node.axis();
    if (!(box.lo[axis] < node.plane() && node.plane() < box.hi[axis])) fault = "a plane outside its cell";
    Box lower = box, upper = box;
    lower.hi[axis] = upper.lo[axis] = node.plane();
    const std::uint32_t behind = visit(index + 1, lower, depth + 1);
    if (behind != node.upper()) fault = "the upper half does not follow the lower one";
    return fault.empty() ? visit(node.upper(), upper, depth + 1) : behind;
  }

  void check_leaf(const KdNode& leaf) {
    if (leaf.first() != next_reference) fault = "leaves do not follow each other";
    next_reference += leaf.count();
    if (next_reference > tree.order.size()) {
      fault = "a leaf beyond the references";
      return;
    }
    for (std::uint32_t i = leaf.first(); i < leaf.first() + leaf.count(); ++i) {
      if (tree.order[i] >= triangles) fault = "a triangle that is none";
      if (i > leaf.first() && tree.order[i] <= tree.order[i - 1]) fault = "a leaf not in the mesh's order";
    }
  }
};

std::string fault_of(const KdTreeParts& tree, const TriangleMesh& mesh, int max_depth) {
  if (tree.nodes.empty()) return tree.order.empty() ? "" : "references without nodes";
  Walk walk{tree, mesh.triangles.size(), 0, 0, {}};
  const std::uint32_t behind = walk.visit(0, tree.box, 1);
  if (!walk.fault.empty()) return walk.fault;
  if (behind != tree.nodes.size()) return "nodes that no cell has";
  if (walk.next_reference != tree.order.size()) return "references that no leaf has";
  return walk.deepest > max_depth ? "too deep" : "";
}

using Point = std::array<mpq_class, 3>;

// Whether a search for the point, in both halves where it lies in a plane, finds a leaf with the triangle.
bool is_found(const KdTreeParts& tree, const Point& point, std::uint32_t triangle, std::uint32_t index = 0) {
  const KdNode& node = tree.nodes[index];
  if (node.is_leaf()) {
    const auto first = tree.order.begin() + node.first();
    return std::binary_search(first, first + node.count(), triangle);
  }
  const mpq_class& x = point[static_cast<std::size_t>(node.axis())];
  const mpq_class plane(node.plane());
  return (x <= plane && is_found(tree, point, triangle, index + 1)) ||
         (x >= plane && is_found(tree, point, triangle, node.upper()));
}

Point mix(const Point& a, const Point& b, const mpq_class& f) {
  Point r;
  for (std::size_t k = 0; k < 3; ++k) r[k] = a[k] + f * (b[k] - a[k]);
  return r;
}

// Exact points of a triangle: corners, points of edges and of the inside, and where edges and lines through a
// corner cross planes of the tree.
std::vector<Point> points_of(Random& random, const TriangleMesh& mesh, const KdTreeParts& tree,
                             std::uint32_t triangle) {
  Point corner[3];
  for (int v = 0; v < 3; ++v) {
    const glm::vec3& p = mesh.positions[mesh.triangles[triangle][v]];
    corner[v] = {mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)};
  }
  const auto share = [&]() -> mpq_class { return mpq_class(random.between(0, 64)) / 64; };
  std::vector<Point> points(corner, corner + 3);
  for (int v = 0; v < 3; ++v) {
    const Point& a = corner[v];
    const Point on_edge = mix(a, corner[(v + 1) % 3], share());
    const Point inside = mix(on_edge, corner[(v + 2) % 3], share());
    points.push_back(on_edge);
    points.push_back(inside);
    const KdNode& node = random.pick(tree.nodes);
    if (node.is_leaf()) continue;
    const auto k = static_cast<std::size_t>(node.axis());
    for (const Point& b : {corner[(v + 1) % 3], inside}) {
      if (a[k] == b[k]) continue;
      mpq_class f = (mpq_class(node.plane()) - a[k]) / (b[k] - a[k]);
      if (f >= 0 && f <= 1) points.push_back(mix(a, b, f));
    }
  }
  return points;
}

std::size_t lost_points(const KdTreeParts& tree, const TriangleMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  std::size_t lost = 0;
  const std::size_t step = mesh.triangles.size() / hard::effort(300) + 1;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const auto triangle = static_cast<std::uint32_t>(i);
    const glm::uvec3& c = mesh.triangles[i];
    if (!detail::triangle_is_finite({mesh.positions[c.x], mesh.positions[c.y], mesh.positions[c.z]}))
      continue;
    for (const Point& point : points_of(random, mesh, tree, triangle))
      lost += is_found(tree, point, triangle) ? 0 : 1;
  }
  return lost;
}

std::vector<Ray> rays_at(const TriangleMesh& mesh, std::uint64_t seed, int count) {
  Random random(seed);
  constexpr const char* kKinds[] = {"at_vertex",    "at_edge",       "at_inside",
                                    "from_surface", "axis_parallel", "in_plane"};
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(hard::ray_of_kind(random, mesh, kKinds[i % 6]));
  return rays;
}

// How many of the rays it answers in another way, one by one and all hits.
template <typename Tree>
std::size_t differences(const Tree& tree, const Structure& expected, const std::vector<Ray>& rays) {
  std::size_t different = 0;
  std::vector<Hit> hits, expected_hits;
  for (const Ray& ray : rays) {
    different += tree.closest(ray) == expected.closest(ray) ? 0 : 1;
    different += tree.any(ray) == expected.any(ray) ? 0 : 1;
    tree.all(ray, hits);
    expected.all(ray, expected_hits);
    different += hits == expected_hits ? 0 : 1;
  }
  return different;
}

}  // namespace

TEST_SUITE("k-d tree") {
  TEST_CASE("on every kind of scene, no point of a triangle is lost, whatever the costs and depth") {
    detail::KdBuildOptions eager;
    eager.node_cost = 0.001;
    detail::KdBuildOptions shallow;
    shallow.max_depth = 5;
    detail::KdBuildOptions lean;
    lean.most_added = 0.1;
    for (const build_scenes::Scene& scene : build_scenes::all(hard::effort(2000u))) {
      CAPTURE(scene.name);
      for (const detail::KdBuildOptions& options : {detail::KdBuildOptions{}, eager, shallow, lean}) {
        const KdTreeParts tree = build(scene.mesh, options);
        CHECK(fault_of(tree, scene.mesh, options.max_depth) == "");
        CHECK(static_cast<double>(tree.order.size()) <=
              (1.0 + options.most_added) * static_cast<double>(scene.mesh.triangles.size()) + 64.0);
        if (!tree.nodes.empty()) CHECK(lost_points(tree, scene.mesh, 1) == 0);
      }
    }
  }

  TEST_CASE("the hard scenes too, where triangles lie in planes and touch them") {
    for (const hard::SceneKind& kind : hard::scene_kinds()) {
      CAPTURE(kind.name);
      for (std::uint64_t seed = 0; seed < hard::effort(20u); ++seed) {
        Random random(seed);
        const TriangleMesh mesh = kind.make(random);
        detail::KdBuildOptions options;
        options.node_cost = 0.001;
        const KdTreeParts tree = build(mesh, options);
        CHECK(fault_of(tree, mesh, options.max_depth) == "");
        if (!tree.nodes.empty()) CHECK(lost_points(tree, mesh, seed) == 0);
      }
    }
  }

  TEST_CASE("the tree does not depend on the threads") {
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    for (const char* name : {"terrain:40000", "teapot-in-stadium:50000", "soup:30000"}) {
      CAPTURE(name);
      const TriangleMesh mesh = builtin_scene(name).mesh;
      detail::KdBuildOptions options;
      const KdTreeParts one = build(mesh, options);
      for (options.threads = 2; options.threads <= 4; ++options.threads)
        CHECK(same(one, build(mesh, options)));
    }
  }

  TEST_CASE("it answers as brute force does on every kind of scene and instruction set") {
    for (const build_scenes::Scene& scene : build_scenes::all(hard::effort(400u))) {
      CAPTURE(scene.name);
      const BruteForce brute(scene.mesh, 5);
      const std::vector<Ray> rays = rays_at(scene.mesh, 2, hard::effort(300));
      const KdTree tree(scene.mesh, {.first_id = 5});
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        CHECK(differences(tree.with_simd(simd), brute, rays) == 0);
        CHECK(differences(KdTree(scene.mesh, {.simd = simd, .first_id = 5}), brute, rays) == 0);
      }
    }
  }

  TEST_CASE("on the built-in scenes it answers as the binary tree does, and is like a k-d tree") {
    for (const char* name :
         {"teapot-in-stadium:10000", "terrain:10000", "grid:20", "grass:10000", "soup:10000", "spheres:10000",
          "quads:100", "cornell", "cornell:5000", "ties:1000"}) {
      CAPTURE(name);
      const TriangleMesh mesh = builtin_scene(name).mesh;
      BuildOptions options;
      options.width = 2;
      const Bvh boxes(mesh, options);
      const KdTree tree(mesh);
      const std::vector<Ray> rays = rays_at(mesh, 3, hard::effort(2000));
      CHECK(differences(tree, boxes, rays) == 0);
      const Statistics statistics = tree.statistics();
      CHECK(statistics.triangles == mesh.triangles.size());
      CHECK(statistics.references >= mesh.triangles.size());
      CHECK(statistics.leaves >= 1);
      CHECK(statistics.width == 2);
      CHECK(statistics.depth <= detail::kMaxKdDepth);
      CHECK(statistics.fill <= 1.0);
      CHECK(statistics.leaf_fill > 0.25);
      CHECK(statistics.leaf_fill <= 1.0);
      CHECK(statistics.sah_cost > 1.0);
      CHECK(statistics.build_seconds > 0.0);
      // A node takes 8 bytes and a block of eight triangles 352.
      CHECK(statistics.bytes >= 8 * statistics.nodes + 44 * statistics.references);
      const TestCounts counts = tree.count_tests(rays);
      CHECK(counts.rays == rays.size());
      CHECK(counts.volumes > rays.size() / 2);
      CHECK(counts.triangles > 0);
    }
  }

  TEST_CASE("no triangle, one, and such as cannot be seen") {
    const Ray ray{{0, 0, 0}, 0.0f, {1, 0, 0}};
    std::vector<Hit> hits{{1.0f, 1}};
    const KdTree none(TriangleMesh{});
    CHECK(none.closest(ray) == Hit{});
    CHECK_FALSE(none.any(ray));
    none.all(ray, hits);
    CHECK(hits.empty());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh mesh{{{1, -1, -1}, {1, 2, -1}, {1, -1, 2}, {nan, 0, 0}}, {{0, 1, 3}, {0, 1, 2}}};
    const KdTree tree(mesh);
    CHECK(tree.closest(ray) == Hit{1.0f, 1});
    CHECK(tree.statistics().unseen_triangles == 1);
    CHECK(tree.statistics().references == 1);
    CHECK(tree.statistics().depth == 1);
    CHECK(KdTree(TriangleMesh{{{nan, 0, 0}}, {{0, 0, 0}}}).closest(ray) == Hit{});
  }

  TEST_CASE("a million equal triangles, and many at one centre, take memory for each once") {
    const auto million = hard::effort(1'000'000u);
    for (const TriangleMesh& mesh :
         {build_scenes::repeated(million), build_scenes::concentric(million / 10)}) {
      const KdTree tree(mesh);
      const std::size_t count = mesh.triangles.size();
      CHECK(tree.statistics().references <= 9 * count + 64);
      const Ray ray{{0.5f, 0.75f, 5.0f}, 0.0f, {0, 0, -1}};
      const Bvh boxes(mesh);
      CHECK(tree.closest(ray) == boxes.closest(ray));
    }
  }

  TEST_CASE("errors and cancelling are as Bvh's") {
    const TriangleMesh mesh = build_scenes::soup(20'000, 1.0f, 0.1f, 1);
    CHECK_THROWS_AS(KdTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), Error);
    CHECK_THROWS_AS(KdTree(mesh, {.threads = -1}), Error);
    CHECK_THROWS_AS(KdTree(mesh, {.first_id = kNone - 19'999}), Error);
    CHECK_THROWS_AS(KdTree(mesh, {.simd = static_cast<Simd>(99)}), Error);
    for (const int threads : {1, 2}) {
      double last = 0.0;
      bool rises = true;
      const KdTree whole(mesh, {.threads = threads, .progress = [&](double share) {
                                  rises = rises && share >= last && share <= 1.0;
                                  last = share;
                                  return true;
                                }});
      CHECK(rises);
      CHECK(last > 0.9);
      CHECK_THROWS_AS(
          KdTree(mesh, {.threads = threads, .progress = [](double share) { return share < 0.3; }}),
          Cancelled);
      CHECK_THROWS_AS(KdTree(mesh, {.threads = threads, .progress = [](double) -> bool { throw 17; }}), int);
    }
  }
}
