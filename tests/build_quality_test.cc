#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "build/binned_sah.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::box_of;
using build_scenes::build;
using build_scenes::doubled_centre;
using build_scenes::joined;
using build_scenes::sah_cost;
using build_scenes::triangles_below;

namespace {

// The least cost of splitting the triangles by one of the planes between `bins` equal slices of an axis.
double best_binned_cost(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles, int bins) {
  double best = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;
    for (const std::uint32_t triangle : triangles) {
      lo = std::min(lo, doubled_centre(mesh, triangle)[axis]);
      hi = std::max(hi, doubled_centre(mesh, triangle)[axis]);
    }
    for (int plane = 1; plane < bins; ++plane) {
      std::vector<std::uint32_t> side[2];
      for (const std::uint32_t triangle : triangles) {
        const double place = (doubled_centre(mesh, triangle)[axis] - lo) / (hi - lo) * bins * (1 - 0x1p-20);
        side[place >= plane ? 1 : 0].push_back(triangle);
      }
      if (!side[0].empty() && !side[1].empty()) best = std::min(best, sah_cost(mesh, side[0], side[1]));
    }
  }
  return best;
}

// Halves by the median centre on the widest axis: what the surface area heuristic must beat.
void median_split(const TriangleMesh& mesh, BinaryTree& tree, std::size_t self, std::uint32_t begin,
                  std::uint32_t end) {
  const auto range = std::span(tree.order).subspan(begin, end - begin);
  const Box box = box_of(mesh, range);
  if (range.size() <= 4) {
    tree.nodes[self] = {box, begin, end - begin};
    return;
  }
  const glm::vec3 size = box.hi - box.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(range.begin(), range.begin() + (middle - begin), range.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return doubled_centre(mesh, a)[axis] < doubled_centre(mesh, b)[axis];
                   });
  const auto first = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes[self] = {box, first, 0};
  tree.nodes.resize(first + 2);
  median_split(mesh, tree, first, begin, middle);
  median_split(mesh, tree, first + 1, middle, end);
}

BinaryTree median_tree(const TriangleMesh& mesh) {
  BinaryTree tree;
  tree.order.resize(mesh.triangles.size());
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  tree.nodes.resize(1);
  median_split(mesh, tree, 0, 0, static_cast<std::uint32_t>(tree.order.size()));
  return tree;
}

}  // namespace

TEST_SUITE("binned SAH quality") {
  TEST_CASE("every split is the cheapest of its bins") {
    for (const TriangleMesh& mesh :
         {build_scenes::soup(2000, 10.0f, 1.0f, 40), build_scenes::teapot_in_stadium(2000, 41),
          build_scenes::grid(30, 3.0f, 42)}) {
      BinnedSahOptions options;
      const BinaryTree tree = build(mesh, options);
      const auto below = triangles_below(tree);
      int splits = 0;
      for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (tree.nodes[i].count != 0 || below[i].size() < 20) continue;
        const int bins = std::min(options.bins, 4 + static_cast<int>(below[i].size() / 16));
        const std::size_t first = tree.nodes[i].first;
        const double cost = sah_cost(mesh, below[first], below[first + 1]);
        // The builder compares costs in float.
        CHECK(cost <= 1.000001 * best_binned_cost(mesh, below[i], bins));
        ++splits;
      }
      CHECK(splits > 50);
    }
  }

  TEST_CASE("trees cost less than halved ones, by far where sizes differ") {
    const auto gain = [](const TriangleMesh& mesh) {
      BinnedSahOptions options;
      options.max_leaf = 4;
      const BinaryTree median = median_tree(mesh);
      CHECK(joined(check_tree(median, mesh, 4)) == "");
      return tree_statistics(median).sah_cost / tree_statistics(build(mesh, options)).sah_cost;
    };
    CHECK(gain(build_scenes::teapot_in_stadium(20000, 43)) > 1.25);
    CHECK(gain(build_scenes::soup(20000, 10.0f, 1.0f, 44)) > 1.02);
    CHECK(gain(build_scenes::grid(100, 3.0f, 45)) > 1.0);
  }
}
