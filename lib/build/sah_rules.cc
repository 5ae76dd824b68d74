#include "build/sah_rules.h"

#include <algorithm>
#include <bit>
#include <string>

#include "plumb/error.h"

namespace plumb::detail {

void require_option(bool holds, const char* type, const char* name, double value, const char* range) {
  if (holds) return;
  throw Error("plumb: " + std::string(type) + "::" + name + " is " + std::to_string(value) + "; it must be " +
              range);
}

void require_tree_size(std::size_t triangles) {
  if (triangles <= kMostTreeTriangles) return;
  throw Error("plumb: " + std::to_string(triangles) +
              " triangles are too many for one tree; split the mesh into parts of at most " +
              std::to_string(kMostTreeTriangles));
}

SahRules::SahRules(const SahOptions& options, const char* type)
    : max_leaf_(static_cast<std::size_t>(options.max_leaf)),
      block_(static_cast<std::size_t>(options.block)),
      block_shift_(std::countr_zero(static_cast<unsigned>(options.block))),
      unit_(static_cast<std::size_t>(std::min(options.block, options.max_leaf))),
      node_cost_(options.node_cost),
      triangle_cost_(options.triangle_cost),
      max_depth_(options.max_depth) {
  const auto require = [&](bool holds, const char* name, double value, const char* range) {
    require_option(holds, type, name, value, range);
  };
  require(options.max_leaf >= 1 && options.max_leaf <= 255, "max_leaf", options.max_leaf, "1 to 255");
  require(
      options.block >= 1 && options.block <= 256 && std::has_single_bit(static_cast<unsigned>(options.block)),
      "block", options.block, "a power of two, 1 to 256");
  require(options.max_depth >= 1 && options.max_depth <= kMaxTreeDepth, "max_depth", options.max_depth,
          "1 to kMaxTreeDepth");
  require(options.node_cost >= 0 && options.node_cost <= 1e6f, "node_cost", options.node_cost, "0 to 1e6");
  require(options.triangle_cost >= 0 && options.triangle_cost <= 1e6f, "triangle_cost", options.triangle_cost,
          "0 to 1e6");
}

bool SahRules::is_leaf_unsearched(std::size_t triangles) const {
  if (triangles == 1) return true;
  return may_be_leaf(triangles) && triangle_cost_ * static_cast<float>(blocks(triangles)) <= node_cost_;
}

// Halving needs bit_width(units - 1) more levels to come to leaves of one unit; a split must leave its
// halves that many.
bool SahRules::must_be_halved(std::size_t triangles, int depth) const {
  return depth + 1 + static_cast<int>(std::bit_width(units(triangles) - 1)) > max_depth_;
}

}  // namespace plumb::detail
