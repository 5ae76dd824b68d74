// Compact trees: what is packed comes out again, by every Highway target, and rays see the same.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compact_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/tree_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

void UnpackAll(const CompactTree<8>& tree, std::uint32_t place, TriangleBlock<8>& block,
               TriangleBlock<8>& one_by_one) {
  Unpack(tree.block(place), block);
  for (size_t lane = 0; lane < 8; ++lane) {
    const Triangle triangle = TriangleAt(tree, place, lane);
    for (int axis = 0; axis < 3; ++axis) {
      one_by_one.vertex[0][axis][lane] = triangle.v0[axis];
      one_by_one.vertex[1][axis][lane] = triangle.v1[axis];
      one_by_one.vertex[2][axis][lane] = triangle.v2[axis];
    }
    one_by_one.id[lane] = IdAt(tree, place, lane);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "base/simd_dispatch.h"
#include "build/binned_sah.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "support/effort.h"
#include "support/random.h"
#include "wide/collapse.h"
#include "wide/compact_tree.h"

namespace plumb::detail {
HWY_EXPORT(UnpackAll);

void unpack_all(const CompactTree<8>& tree, std::uint32_t place, TriangleBlock<8>& block,
                TriangleBlock<8>& one_by_one, Simd simd) {
  PLUMB_DISPATCH(UnpackAll, simd)(tree, place, block, one_by_one);
}
}  // namespace plumb::detail

using namespace plumb;
using namespace plumb::detail;

namespace {

WideTree<8> wide_tree(const TriangleMesh& mesh, int max_leaf = 8) {
  BinnedSahOptions options;
  options.max_leaf = max_leaf;
  options.block = 8;
  return collapse<8>(build_scenes::build(mesh, options), mesh, 5, 1);
}

// Triangles that share nothing: 24 vertices a block.
TriangleMesh apart(int triangles) {
  hard::Random random(3);
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) build_scenes::add(mesh, random.unit3(), random.unit3(), random.unit3());
  return mesh;
}

template <typename T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void check_blocks(const TriangleMesh& mesh, int max_leaf) {
  const WideTree<8> wide = wide_tree(mesh, max_leaf);
  const CompactTree<8> packed = compact(wide, 1);
  REQUIRE(packed.nodes.size() == wide.nodes.size());
  CHECK(packed.greatest == wide.greatest);
  for (const Simd simd : simd_targets()) {
    CAPTURE(simd_name(simd));
    for (std::size_t n = 0; n < wide.nodes.size(); ++n) {
      const WideNode<8>&from = wide.nodes[n], &node = packed.nodes[n];
      CHECK(same_bits(node.bounds, from.bounds));
      CHECK(same_bits(node.count, from.count));
      for (int i = 0; i < 8; ++i) {
        if (node.count[i] == 0) {
          CHECK(node.child[i] == from.child[i]);
          continue;
        }
        std::uint32_t place = node.child[i];
        for (std::uint32_t first = 0; first < from.count[i]; first += 8, place = packed.next(place)) {
          const TriangleBlock<8>& expected = wide.blocks[from.child[i] + first / 8];
          TriangleBlock<8> block, one_by_one;
          unpack_all(packed, place, block, one_by_one, simd);
          for (std::uint32_t lane = 0; lane < 8 && first + lane < from.count[i]; ++lane) {
            bool same = block.id[lane] == expected.id[lane] && one_by_one.id[lane] == expected.id[lane];
            for (int k = 0; k < 9; ++k) {
              const float want = expected.vertex[k / 3][k % 3][lane];
              same = same && same_bits(block.vertex[k / 3][k % 3][lane], want) &&
                     same_bits(one_by_one.vertex[k / 3][k % 3][lane], want);
            }
            CHECK(same);
            // A bound of the sums in float in any order, and hardly more.
            double sum[2] = {};
            for (int v = 1; v < 3; ++v) {
              for (int axis = 0; axis < 3; ++axis) {
                const float difference = block.vertex[v][axis][lane] - block.vertex[0][axis][lane];
                sum[v - 1] += double{std::fabs(difference)};
              }
            }
            const double length = std::max(sum[0], sum[1]);
            const double extent = block.extent[lane];
            const bool bounds = extent >= std::max(length * (1.0 + 2 * 0x1p-24), 0x1p-30) &&
                                (length > 1e38 || extent <= std::max(length * (1.0 + 12 * 0x1p-24), 0x1p-30));
            CHECK(bounds);
          }
        }
      }
    }
  }
}

}  // namespace

TEST_SUITE("compact") {
  TEST_CASE("blocks come out as they were, on every instruction set") {
    for (const build_scenes::Scene& scene : build_scenes::all(200)) {
      CAPTURE(scene.name);
      check_blocks(scene.mesh, 8);
    }
    SUBCASE("vertices that no one shares") { check_blocks(apart(100), 8); }
    SUBCASE("leaves of several blocks") { check_blocks(apart(100), 255); }
    SUBCASE("0 and -0 are different inputs") {
      TriangleMesh mesh;
      build_scenes::add(mesh, {0, 0, 1}, {1, -0.0f, 0}, {0, 1, -0.0f});
      build_scenes::add(mesh, {-0.0f, 0, 1}, {1, 0, 0}, {-0.0f, 1, 0});
      check_blocks(mesh, 8);
    }
  }

  TEST_CASE("the packed bytes do not depend on threads") {
    const TriangleMesh mesh = build_scenes::soup(20000, 1.0f, 0.1f, 4);
    const CompactTree<8> one = compact(wide_tree(mesh), 1), many = compact(wide_tree(mesh), 3);
    REQUIRE(one.units.size() == many.units.size());
    CHECK(std::memcmp(one.units.data(), many.units.data(), one.units.size() * sizeof one.units[0]) == 0);
  }

  TEST_CASE("rays see the same, and a mesh whose triangles share vertices takes less memory") {
    for (const build_scenes::Scene& scene : build_scenes::all(400)) {
      CAPTURE(scene.name);
      const Bvh plain(scene.mesh), packed(scene.mesh, {.compact = true});
      std::vector<Ray> rays;
      hard::Random random(9);
      for (int i = 0; i < hard::effort(64); ++i) {
        const auto corner = [&] {
          return scene.mesh.positions[random.below(static_cast<std::uint32_t>(scene.mesh.positions.size()))];
        };
        const glm::vec3 from = corner() * 1.5f + random.unit3();
        rays.push_back({from, 0.0f, corner() - from, std::numeric_limits<float>::infinity()});
      }
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        const Bvh bvh = packed.with_simd(simd);
        for (const Ray& ray : rays) {
          CHECK(bvh.closest(ray) == plain.closest(ray));
          CHECK(bvh.any(ray) == plain.any(ray));
        }
        std::vector<Hit> hits(rays.size()), all, expected;
        bvh.closest(rays, hits);
        for (std::size_t i = 0; i < rays.size(); ++i) CHECK(hits[i] == plain.closest(rays[i]));
        for (std::size_t i = 0; i < rays.size(); i += 8) {
          bvh.all(rays[i], all);
          plain.all(rays[i], expected);
          CHECK(all == expected);
        }
      }
      CHECK(packed.statistics().nodes == plain.statistics().nodes);
      CHECK(packed.statistics().sah_cost == plain.statistics().sah_cost);
    }
    // A height field.
    TriangleMesh mesh;
    constexpr std::uint32_t kSide = 60;
    for (std::uint32_t i = 0; i <= kSide; ++i) {
      for (std::uint32_t j = 0; j <= kSide; ++j)
        mesh.positions.push_back(
            {static_cast<float>(i), static_cast<float>(i * j % 7), static_cast<float>(j)});
    }
    for (std::uint32_t i = 0; i < kSide; ++i) {
      for (std::uint32_t j = 0; j < kSide; ++j) {
        const std::uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
      }
    }
    const double share = static_cast<double>(Bvh(mesh, {.compact = true}).statistics().bytes) /
                         static_cast<double>(Bvh(mesh).statistics().bytes);
    CAPTURE(share);
    CHECK(share < 0.65);
  }

  TEST_CASE("units are counted up to 32 bits and not beyond") {
    std::vector<std::uint32_t> units = {0, 0xfffffff0u, 0xfu};
    sum_units(units);
    CHECK(units == std::vector<std::uint32_t>{0, 0xfffffff0u, 0xffffffffu});
    units = {0, 0xfffffff0u, 0x10u};
    CHECK_THROWS_AS(sum_units(units), Error);
  }

  TEST_CASE("an empty scene, and options that it is not for") {
    const Bvh empty(MeshView{}, {.compact = true});
    CHECK(empty.closest(Ray{{0, 0, 0}, 0, {0, 0, 1}, 9}) == Hit{});
    CHECK_THROWS_AS(Bvh(MeshView{}, {.width = 4, .compact = true}), Error);
    CHECK_THROWS_AS(Bvh(MeshView{}, {.arithmetic = Arithmetic::Fast, .compact = true}), Error);
  }
}
#endif
