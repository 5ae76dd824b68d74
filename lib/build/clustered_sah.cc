#include "build/clustered_sah.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "build/binned_sah.h"
#include "build/chunks.h"
#include "build/morton_order.h"
#include "build/sah_bins.h"
#include "build/triangle_refs.h"

namespace plumb::detail {
namespace {

// Parts of the curve up to this length are made into treelets by one thread each.
constexpr std::size_t kPartSize = 4096;
// Most triangles of a treelet.
constexpr std::size_t kTreelet = 64;
// Most nodes on a path through one.
constexpr int kTreeletDepth = 16;
constexpr int kBins = 16;
constexpr std::size_t kPieceSize = 32768;
// Runs up to this length are cut where that costs least, longer ones where cells end.
constexpr std::size_t kSwept = 16;

// The triangles [begin, end) of the curve.
struct Run {
  std::size_t begin, end;

  std::size_t size() const { return end - begin; }
};

// Where the curve leaves the larger of its cells that the run begins in; the run is in more than one.
std::size_t cell_end(std::span<const MortonKey> keys, const Run& run) {
  const std::uint32_t first = morton_code(keys[run.begin]);
  const std::uint32_t last = morton_code(keys[run.end - 1]);
  const int bit = static_cast<int>(std::bit_width(first ^ last)) - 1;
  const MortonKey end = MortonKey{last >> bit << bit} << 32;
  const auto begin = keys.begin();
  const auto place = std::lower_bound(begin + static_cast<std::ptrdiff_t>(run.begin),
                                      begin + static_cast<std::ptrdiff_t>(run.end), end);
  return static_cast<std::size_t>(place - begin);
}

bool in_one_cell(std::span<const MortonKey> keys, const Run& run) {
  return morton_code(keys[run.begin]) == morton_code(keys[run.end - 1]);
}

// Treelets that one thread has made: their roots, and all nodes below, whose indices the nodes above hold.
// Leaves hold places on the curve.
struct Treelets {
  std::vector<BinaryNode> roots;
  std::vector<BinaryNode> nodes;
};

// Makes the treelet of a run. Its triangles are copied to where they are at hand.
class TreeletBuilder {
 public:
  TreeletBuilder(const SahRules& rules, const TriangleRefs& refs, Treelets& out)
      : rules_(rules), refs_(refs), unit_(splat(refs.unit)), out_(out) {}

  // From here on the run's keys are no keys: the lower halves hold indices into the mesh.
  void build(std::span<MortonKey> keys, const Run& run) {
    origin_ = run.begin;
    keys_ = keys.subspan(run.begin, run.size());
    for (std::size_t i = 0; i < run.size(); ++i) {
      // They lie all over the array; those of the next treelet are asked for ahead.
      const std::size_t later = run.begin + i + kTreelet;
      if (later < keys.size()) __builtin_prefetch(&refs_.refs[morton_item(keys[later])]);
      items_[i] = refs_.refs[morton_item(keys_[i])];
    }
    Box4 box;
    out_.roots.push_back(make_node({0, run.size()}, 1, box));
    for (std::size_t i = 0; i < run.size(); ++i) keys_[i] = items_[i].index();
  }

 private:
  // Grows the box by the node's.
  BinaryNode make_node(const Run& run, int depth, Box4& outer) {
    Box4 box;
    if (rules_.may_be_leaf(run.size())) {
      for (std::size_t i = run.begin; i < run.end; ++i) box.add(items_[i].lo, items_[i].hi);
      outer.add(box);
      return {box.box(), static_cast<std::uint32_t>(origin_ + run.begin),
              static_cast<std::uint32_t>(run.size())};
    }
    const std::size_t middle = place_of_cut(run, depth);
    const std::size_t first = out_.nodes.size();
    out_.nodes.resize(first + 2);
    const BinaryNode left = make_node({run.begin, middle}, depth + 1, box);
    const BinaryNode right = make_node({middle, run.end}, depth + 1, box);
    out_.nodes[first] = left;
    out_.nodes[first + 1] = right;
    outer.add(box);
    return {box.box(), static_cast<std::uint32_t>(first), 0};
  }

  std::size_t place_of_cut(const Run& run, int depth) const {
    if (rules_.must_be_halved(run.size(), depth)) return run.begin + rules_.left_half(run.size());
    if (run.size() <= kSwept || in_one_cell(keys_, run)) return cheapest_cut(run);
    return cell_end(keys_, run);
  }

  // The surface area heuristic along the curve.
  std::size_t cheapest_cut(const Run& run) const {
    const std::size_t count = run.size();
    const TriangleRef* const items = items_ + run.begin;
    const auto cost = [&](const Box4& box, std::size_t triangles) {
      return half_area(box, unit_) * static_cast<float>(rules_.blocks(triangles));
    };
    float right_cost[kTreelet];
    Box4 box;
    for (std::size_t i = count; i-- > 1;) {
      box.add(items[i].lo, items[i].hi);
      right_cost[i] = cost(box, count - i);
    }
    box = {};
    float least = std::numeric_limits<float>::infinity();
    std::size_t best = count / 2;
    std::size_t imbalance = count;
    for (std::size_t left = 1; left < count; ++left) {
      box.add(items[left - 1].lo, items[left - 1].hi);
      const float sum = cost(box, left) + right_cost[left];
      // Among equals the one that halves it best.
      const std::size_t from_half = left > count / 2 ? left - count / 2 : count / 2 - left;
      if (!(sum < least || (sum == least && from_half < imbalance))) continue;
      least = sum;
      imbalance = from_half;
      best = left;
    }
    return run.begin + best;
  }

  const SahRules& rules_;
  const TriangleRefs& refs_;
  const Float4 unit_;
  Treelets& out_;
  std::size_t origin_ = 0;  // of the treelet, on the curve
  std::span<MortonKey> keys_;
  TriangleRef items_[kTreelet];
};

class Clusters {
 public:
  Clusters(const SahRules& rules, MeshView mesh)
      : rules_(rules), refs_(make_triangle_refs(mesh)), keys_(morton_order(refs_)) {
    if (refs_.count == 0) return;
    std::vector<Run> parts;
    cut_into_parts({0, refs_.count}, parts);
    parts_.resize(parts.size());
    for_pieces(parts.size(), piece_count(parts.size(), 4),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   parts_[i].nodes.reserve(parts[i].size() / 2);
                   TreeletBuilder builder(rules_, refs_, parts_[i]);
                   cut(parts[i], builder);
                 }
               });
  }

  // What the builder of the tree above sorts: the treelets as if they were triangles.
  TriangleRefs items() const {
    TriangleRefs items;
    for (const Treelets& part : parts_) items.count += part.roots.size();
    items.refs = make_large_array<TriangleRef>(items.count);
    items.unit = refs_.unit;
    items.box = refs_.box;
    std::uint32_t index = 0;
    for (const Treelets& part : parts_) {
      for (const BinaryNode& root : part.roots) {
        TriangleRef& item = items.refs[index];
        item.lo = Float4{root.box.lo.x, root.box.lo.y, root.box.lo.z, 0.0f};
        item.hi = Float4{root.box.hi.x, root.box.hi.y, root.box.hi.z, 0.0f};
        item.set_index(index++);
      }
    }
    return items;
  }

  // Makes a tree over treelets, one in each leaf, one over triangles. Roots replace leaves; the other nodes
  // of the parts follow the tree's.
  void expand(BinaryTree& tree) const {
    const std::size_t above = tree.nodes.size();
    std::vector<std::size_t> begin(1, above);  // of the parts' nodes
    std::vector<BinaryNode> roots;
    for (const Treelets& part : parts_) {
      for (const BinaryNode& root : part.roots) roots.push_back(moved(root, begin.back()));
      begin.push_back(begin.back() + part.nodes.size());
    }
    tree.nodes.resize(begin.back());
    for (std::size_t i = 0; i < above; ++i) {
      BinaryNode& node = tree.nodes[i];
      if (node.count != 0) node = roots[tree.order[node.first]];
    }
    tree.order.resize(refs_.count);
    for_pieces(parts_.size(), piece_count(parts_.size(), 4),
               [&](std::size_t, std::size_t first, std::size_t last) {
                 for (std::size_t i = first; i < last; ++i) {
                   std::transform(parts_[i].nodes.begin(), parts_[i].nodes.end(),
                                  tree.nodes.begin() + static_cast<std::ptrdiff_t>(begin[i]),
                                  [&](const BinaryNode& node) { return moved(node, begin[i]); });
                 }
               });
    for_pieces(keys_.size(), piece_count(keys_.size(), kPieceSize),
               [&](std::size_t, std::size_t first, std::size_t last) {
                 for (std::size_t i = first; i < last; ++i) tree.order[i] = morton_item(keys_[i]);
               });
    tree.unseen = refs_.unseen;
  }

 private:
  // A node of a part whose nodes begin at `begin`.
  static BinaryNode moved(BinaryNode node, std::size_t begin) {
    if (node.count == 0) node.first += static_cast<std::uint32_t>(begin);
    return node;
  }

  void cut_into_parts(const Run& run, std::vector<Run>& parts) const {
    if (run.size() <= kPartSize || in_one_cell(keys_, run)) {
      parts.push_back(run);
      return;
    }
    const std::size_t middle = cell_end(keys_, run);
    cut_into_parts({run.begin, middle}, parts);
    cut_into_parts({middle, run.end}, parts);
  }

  void cut(const Run& run, TreeletBuilder& builder) {
    if (run.size() <= kTreelet) {
      builder.build(keys_, run);
    } else if (!in_one_cell(keys_, run) || refine(run)) {
      const std::size_t middle = cell_end(keys_, run);
      cut({run.begin, middle}, builder);
      cut({middle, run.end}, builder);
    } else {
      for (std::size_t begin = run.begin; begin < run.end; begin += kTreelet) {
        builder.build(keys_, {begin, std::min(begin + kTreelet, run.end)});
      }
    }
  }

  // Sorts the run along a curve through its own centres; false if they are too close together for one.
  bool refine(const Run& run) {
    Box4 centres;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Float4 centre = doubled_centre(refs_.refs[morton_item(keys_[i])], splat(refs_.unit));
      centres.add(centre, centre);
    }
    const MortonMap map(centres, refs_.unit);
    const auto keys = std::span(keys_).subspan(run.begin, run.size());
    for (MortonKey& key : keys) key = map.key(refs_.refs[morton_item(key)], morton_item(key));
    std::sort(keys.begin(), keys.end());
    return !in_one_cell(keys_, run);
  }

  const SahRules& rules_;
  TriangleRefs refs_;
  UnsetVector<MortonKey> keys_;
  std::vector<Treelets> parts_;
};

SahRules treelet_rules(ClusteredSahOptions options) {
  options.max_depth = kTreeletDepth;
  return SahRules(options, "ClusteredSahOptions");
}

}  // namespace

BinaryTree build_clustered_sah(MeshView mesh, const ClusteredSahOptions& options, Progress& progress) {
  const SahRules rules = treelet_rules(options);
  require_tree_size(mesh.triangles.size());
  BinaryTree tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    const Clusters clusters(rules, mesh);
    TriangleRefs items = clusters.items();
    // A step of the progress is a triangle; the builder below takes one for each item.
    progress.add(mesh.triangles.size() - items.count);
    progress.throw_if_cancelled();
    BinnedSahOptions top;
    top.max_leaf = 1;
    top.bins = kBins;
    top.max_depth = kMaxTreeDepth - kTreeletDepth;
    tree = build_binned_sah(std::move(items), top, progress);
    clusters.expand(tree);
  });
  return tree;
}

}  // namespace plumb::detail
