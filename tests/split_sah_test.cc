// Trees with spatial splits, and reinsertion.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gmpxx.h>

#include "build/binned_sah.h"
#include "build/reinsertion.h"
#include "build/split_reference.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "support/fp_modes.h"
#include "support/random.h"
#include "wide/collapse.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::build;
using build_scenes::joined;
using build_scenes::same;
using plumb::hard::Random;

namespace {

BinnedSahOptions split_options(int leaf) {
  BinnedSahOptions options;
  options.block = options.max_leaf = leaf;
  options.duplicates = 0.5f;
  return options;
}

BinaryTree improved(BinaryTree tree) {
  Progress progress(nullptr, 1);
  reinsert(tree, {}, progress, 1);
  return tree;
}

using Point = std::array<mpq_class, 3>;

// What of a triangle is at one side of a plane, exactly.
std::vector<Point> exact_side(const TriangleMesh& mesh, std::size_t axis, float plane, int sign) {
  std::vector<Point> corners, kept;
  for (int v = 0; v < 3; ++v) {
    const glm::vec3& p = mesh.positions[mesh.triangles[0][v]];
    corners.push_back({mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)});
  }
  const mpq_class at(plane);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& a = corners[i];
    const Point& b = corners[(i + 1) % 3];
    const mpq_class outside_a = sign * (a[axis] - at), outside_b = sign * (b[axis] - at);
    if (outside_a <= 0) kept.push_back(a);
    if ((outside_a < 0 && outside_b > 0) || (outside_a > 0 && outside_b < 0)) {
      const mpq_class f = (at - a[axis]) / (b[axis] - a[axis]);
      Point r;
      for (std::size_t k = 0; k < 3; ++k) r[k] = a[k] + f * (b[k] - a[k]);
      kept.push_back(r);
    }
  }
  return kept;
}

bool holds(const TriangleRef& ref, const Point& p) {
  for (int k = 0; k < 3; ++k) {
    const mpq_class& x = p[static_cast<std::size_t>(k)];
    if (x < mpq_class(ref.lo[k]) || x > mpq_class(ref.hi[k])) return false;
  }
  return true;
}

}  // namespace

TEST_SUITE("spatial splits") {
  TEST_CASE("each side's box holds every exact point of the triangle at that side") {
    Random random(1);
    int split = 0;
    for (int i = 0; i < 20000; ++i) {
      const float scale = std::ldexp(1.0f, random.one_in(2) ? 0 : random.between(-140, 125));
      const glm::vec3 centre = random.unit3() * scale;
      const float size = scale * std::ldexp(1.0f, -random.between(0, 22));
      TriangleMesh mesh;
      build_scenes::add(mesh, centre + random.unit3() * size, centre + random.unit3() * size,
                        centre + random.unit3() * size);
      const Float4 lo = make_triangle_refs(mesh).refs[0].lo, hi = make_triangle_refs(mesh).refs[0].hi;
      TriangleRef ref;
      ref.lo = lo;
      ref.hi = hi;
      ref.set_index(0);
      const int axis = static_cast<int>(random.below(3));
      const float plane = lo[axis] + (hi[axis] - lo[axis]) * 0.5f * (random.unit() + 1.0f) + 0.0f;
      if (!(plane > lo[axis] && plane < hi[axis])) continue;
      ++split;
      TriangleRef parts[2];
      const Sides sides = split_reference(mesh, ref, axis, plane, parts[0], parts[1]);
      CHECK(sides.left);
      CHECK(sides.right);
      const float end = parts[0].hi[axis], begin = parts[1].lo[axis];  // Clang binds no reference to a lane
      CHECK(end <= plane);
      CHECK(begin >= plane);
      for (int side = 0; side < 2; ++side) {
        CHECK(parts[side].index() == 0);
        for (const Point& p : exact_side(mesh, static_cast<std::size_t>(axis), plane, side == 0 ? 1 : -1))
          CHECK(holds(parts[side], p));
      }
    }
    CHECK(split > 5000);
  }

  TEST_CASE("every tree over every kind of scene holds its invariants, as do the trees made of it") {
    for (const build_scenes::Scene& scene : build_scenes::all(2000)) {
      CAPTURE(scene.name);
      for (const int leaf : {1, 8}) {
        const BinaryTree tree = build(scene.mesh, split_options(leaf));
        CHECK(joined(check_tree(tree, scene.mesh, leaf, References::Several)) == "");
        CHECK(tree.order.size() <= scene.mesh.triangles.size() * 3 / 2);
        const BinaryTree better = improved(tree);
        CHECK(joined(check_tree(better, scene.mesh, leaf, References::Several)) == "");
        CHECK(joined(check_tree(collapse<8>(better, scene.mesh, 3, 1), scene.mesh, 3, leaf,
                                References::Several)) == "");
      }
    }
  }

  TEST_CASE("the check sees a part that is missing") {
    const TriangleMesh mesh = build_scenes::soup(500, 1.0f, 1.0f, 5);
    BinaryTree tree = build(mesh, split_options(1));
    REQUIRE(tree.order.size() > 500);
    for (BinaryNode& node : tree.nodes) {
      if (node.count == 0) continue;
      node.box.hi.x = node.box.lo.x;
      break;
    }
    CHECK(joined(check_tree(tree, mesh, 1, References::Several)).find("not covered") != std::string::npos);
  }

  TEST_CASE("the tree depends on neither the threads nor the caller's floating-point mode") {
    for (const build_scenes::Scene& scene : build_scenes::all(30000)) {
      CAPTURE(scene.name);
      BinnedSahOptions options = split_options(8);
      options.threads = 1;
      const BinaryTree alone = improved(build(scene.mesh, options));
      options.threads = 3;
      const BinaryTree other =
          hard::under_mode(hard::kOddestFpMode, [&] { return improved(build(scene.mesh, options)); });
      CHECK(same(other, alone));
    }
  }

  TEST_CASE("large triangles among small ones cost less when they are split") {
    TriangleMesh mesh = build_scenes::soup(20000, 1.0f, 0.02f, 6);
    Random random(8);
    for (int i = 0; i < 100; ++i) build_scenes::add(mesh, random.unit3(), random.unit3(), random.unit3());
    BinnedSahOptions whole = split_options(8);
    whole.duplicates = 0;
    const double before = tree_statistics(build(mesh, whole)).sah_cost;
    const double after = tree_statistics(build(mesh, split_options(8))).sah_cost;
    CAPTURE(after / before);
    CHECK(after < 0.95 * before);
  }

  TEST_CASE("reinsertion never makes a tree cost more, and keeps its invariants") {
    for (const build_scenes::Scene& scene : build_scenes::all(20000)) {
      CAPTURE(scene.name);
      BinnedSahOptions options;
      options.max_leaf = 4;
      const BinaryTree tree = build(scene.mesh, options);
      const BinaryTree better = improved(tree);
      CHECK(joined(check_tree(better, scene.mesh, 4)) == "");
      CHECK(tree_statistics(better).sah_cost <= tree_statistics(tree).sah_cost * 1.000001);
    }
  }

  TEST_CASE("every quality answers as brute force does") {
    for (const build_scenes::Scene& scene : build_scenes::all(600)) {
      CAPTURE(scene.name);
      const BruteForce brute(scene.mesh);
      for (const int width : {2, 4, 8}) {
        const Bvh best(scene.mesh, {.quality = Quality::Best, .width = width});
        CHECK(best.statistics().references >=
              best.statistics().triangles - best.statistics().unseen_triangles);
        Random random(7);
        for (int i = 0; i < 100; ++i) {
          const auto corner = [&] {
            return scene.mesh
                .positions[random.below(static_cast<std::uint32_t>(scene.mesh.positions.size()))];
          };
          const glm::vec3 from = corner() * 1.5f + random.unit3(), to = corner();
          const Ray ray{from, 0.0f, to - from, std::numeric_limits<float>::infinity()};
          CHECK(best.closest(ray) == brute.closest(ray));
          CHECK(best.any(ray) == brute.any(ray));
          std::vector<Hit> all, expected;
          best.all(ray, all);
          brute.all(ray, expected);
          CHECK(all == expected);
        }
      }
    }
  }

  TEST_CASE("progress reaches the end and can cancel; duplicates out of range are an error") {
    const TriangleMesh mesh = build_scenes::soup(50000, 10.0f, 1.0f, 24);
    double last = 0.0;
    bool rising = true;
    const Bvh whole(mesh, {.quality = Quality::Best, .progress = [&](double share) {
                             rising = rising && share >= last;
                             last = share;
                             return true;
                           }});
    CHECK(rising);
    CHECK(last > 0.99);
    for (const double most : {0.1, 0.5, 0.95}) {
      CHECK_THROWS_AS(
          Bvh(mesh, {.quality = Quality::Best, .progress = [&](double share) { return share < most; }}),
          Cancelled);
    }
    BinnedSahOptions options;
    options.duplicates = 1.5f;
    CHECK_THROWS_AS(build(mesh, options), Error);
  }
}
