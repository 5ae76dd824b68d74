#include "build/clustered_sah.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "build/binned_sah.h"
#include "build/chunks.h"
#include "build/morton_order.h"
#include "build/triangle_refs.h"

namespace plumb::detail {
namespace {

// Parts of the curve up to this length are cut into leaves by one thread each.
constexpr std::size_t kPartSize = 4096;
constexpr int kBins = 16;
// Runs up to this length are cut where that costs least, longer ones where cells end.
constexpr std::size_t kSwept = 16;

// The triangles [begin, end) of the curve.
struct Run {
  std::size_t begin, end;

  std::size_t size() const { return end - begin; }
};

// A leaf to be.
struct Cluster {
  Run run;
  Box4 box;
};

class Clusters {
 public:
  Clusters(const ClusteredSahOptions& options, const SahRules& rules, MeshView mesh)
      : rules_(rules),
        max_leaf_(static_cast<std::size_t>(options.max_leaf)),
        refs_(make_triangle_refs(mesh)),
        keys_(morton_order(refs_)) {
    if (refs_.count == 0) return;
    std::vector<Run> parts;
    cut_into_parts({0, refs_.count}, parts);
    std::vector<std::vector<Cluster>> clusters(parts.size());
    for_pieces(parts.size(), piece_count(parts.size(), 4),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) cut(parts[i], clusters[i]);
               });
    for (const std::vector<Cluster>& some : clusters)
      clusters_.insert(clusters_.end(), some.begin(), some.end());
  }

  std::uint32_t unseen() const { return refs_.unseen; }
  std::size_t triangles() const { return refs_.count; }

  // What the builder of the tree sorts: the clusters as if they were triangles.
  TriangleRefs items() const {
    TriangleRefs items;
    items.count = clusters_.size();
    items.refs = std::make_unique_for_overwrite<TriangleRef[]>(items.count);
    items.unit = refs_.unit;
    items.box = refs_.box;
    for (std::size_t i = 0; i < items.count; ++i) {
      items.refs[i].lo = clusters_[i].box.lo;
      items.refs[i].hi = clusters_[i].box.hi;
      items.refs[i].set_index(static_cast<std::uint32_t>(i));
    }
    return items;
  }

  // Makes a tree over clusters one over triangles.
  void expand(BinaryTree& tree) const {
    std::vector<std::uint32_t> begin(clusters_.size() + 1);  // of the triangles, by place in the order
    std::vector<std::uint32_t> order;
    order.reserve(refs_.count);
    for (std::size_t place = 0; place < clusters_.size(); ++place) {
      const Run& run = clusters_[tree.order[place]].run;
      for (std::size_t i = run.begin; i < run.end; ++i) order.push_back(morton_item(keys_[i]));
      begin[place + 1] = static_cast<std::uint32_t>(order.size());
    }
    for (BinaryNode& node : tree.nodes) {
      if (node.count == 0) continue;
      node.count = begin[node.first + node.count] - begin[node.first];
      node.first = begin[node.first];
    }
    tree.order = std::move(order);
    tree.unseen = refs_.unseen;
  }

 private:
  // Where the curve leaves the larger of its cells that the run begins in; the run is in more than one.
  std::size_t cell_end(const Run& run) const {
    const std::uint32_t first = morton_code(keys_[run.begin]);
    const std::uint32_t last = morton_code(keys_[run.end - 1]);
    const MortonKey end =
        MortonKey{last >> (std::bit_width(first ^ last) - 1) << (std::bit_width(first ^ last) - 1)} << 32;
    const auto place = std::lower_bound(keys_.begin() + static_cast<std::ptrdiff_t>(run.begin),
                                        keys_.begin() + static_cast<std::ptrdiff_t>(run.end), end);
    return static_cast<std::size_t>(place - keys_.begin());
  }

  bool in_one_cell(const Run& run) const {
    return morton_code(keys_[run.begin]) == morton_code(keys_[run.end - 1]);
  }

  void cut_into_parts(const Run& run, std::vector<Run>& parts) const {
    if (run.size() <= kPartSize || in_one_cell(run)) {
      parts.push_back(run);
      return;
    }
    const std::size_t middle = cell_end(run);
    cut_into_parts({run.begin, middle}, parts);
    cut_into_parts({middle, run.end}, parts);
  }

  void cut(const Run& run, std::vector<Cluster>& out) {
    if (run.size() <= max_leaf_) {
      emit(run, out);
    } else if (!in_one_cell(run) || refine(run)) {
      const std::size_t middle = run.size() > kSwept ? cell_end(run) : cheapest_cut(run);
      cut({run.begin, middle}, out);
      cut({middle, run.end}, out);
    } else {
      for (std::size_t begin = run.begin; begin < run.end; begin += max_leaf_) {
        emit({begin, std::min(begin + max_leaf_, run.end)}, out);
      }
    }
  }

  // The surface area heuristic along the curve.
  std::size_t cheapest_cut(const Run& run) const {
    const std::size_t count = run.size();
    const Float4 unit = splat(refs_.unit);
    const auto cost = [&](const Box4& box, std::size_t triangles) {
      return half_area(box, unit) * static_cast<float>(rules_.blocks(triangles));
    };
    const auto grow = [&](Box4& box, std::size_t i) {
      const TriangleRef& ref = refs_.refs[morton_item(keys_[run.begin + i])];
      box.add(ref.lo, ref.hi);
    };
    float right_cost[kSwept];
    Box4 box;
    for (std::size_t i = count; i-- > 1;) {
      grow(box, i);
      right_cost[i] = cost(box, count - i);
    }
    box = {};
    float least = std::numeric_limits<float>::infinity();
    std::size_t best = count / 2;
    for (std::size_t left = 1; left < count; ++left) {
      grow(box, left - 1);
      const float sum = cost(box, left) + right_cost[left];
      if (!(sum < least)) continue;
      least = sum;
      best = left;
    }
    return run.begin + best;
  }

  // Sorts the run along a curve through its own centres; false if they are too close together for one.
  bool refine(const Run& run) {
    Box4 centres;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Float4 centre = doubled_centre(refs_.refs[morton_item(keys_[i])], splat(refs_.unit));
      centres.add(centre, centre);
    }
    const BinMap map = morton_map(centres, refs_.unit);
    const auto keys = std::span(keys_).subspan(run.begin, run.size());
    for (MortonKey& key : keys) key = morton_key(refs_.refs[morton_item(key)], morton_item(key), map);
    std::sort(keys.begin(), keys.end());
    return !in_one_cell(run);
  }

  // From here on the run's keys hold the triangles' indices in the mesh, not those of their refs.
  void emit(const Run& run, std::vector<Cluster>& out) {
    Box4 box;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const TriangleRef& ref = refs_.refs[morton_item(keys_[i])];
      box.add(ref.lo, ref.hi);
      keys_[i] = ref.index();
    }
    out.push_back({run, box});
  }

  const SahRules& rules_;
  std::size_t max_leaf_;
  TriangleRefs refs_;
  std::vector<MortonKey> keys_;
  std::vector<Cluster> clusters_;
};

}  // namespace

BinaryTree build_clustered_sah(MeshView mesh, const ClusteredSahOptions& options, Progress& progress) {
  const SahRules rules(options, "ClusteredSahOptions");
  require_tree_size(mesh.triangles.size());
  BinaryTree tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    const Clusters clusters(options, rules, mesh);
    TriangleRefs items = clusters.items();
    // A step of the progress is a triangle; the builder below takes one for each item.
    progress.add(clusters.unseen() + (clusters.triangles() - items.count));
    progress.throw_if_cancelled();
    BinnedSahOptions top;
    top.max_leaf = 1;
    top.bins = kBins;
    top.max_depth = options.max_depth;
    tree = build_binned_sah(std::move(items), top, progress);
    clusters.expand(tree);
  });
  return tree;
}

}  // namespace plumb::detail
