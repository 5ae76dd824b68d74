#include "build/binned_sah.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <oneapi/tbb/parallel_invoke.h>

#include "base/fp_mode.h"
#include "build/chunks.h"
#include "build/sah_bins.h"
#include "build/triangle_refs.h"
#include "plumb/error.h"

// References to the triangles lie in two buffers; a split copies a range of one to the same range of
// the other, keeping the order on both sides. So the tree depends on neither threads nor pieces:
// counts, minima and maxima are the same in whatever order they are taken.
//
// Ranges above kSubtree triangles are split by all threads together and their halves become tasks; a
// smaller one is built by one thread into an array of its own. At the end all are laid out
// depth-first.

namespace plumb::detail {
namespace {

constexpr std::size_t kSubtree = 4096;
constexpr std::size_t kPieceSize = 8192;

// Triangles [begin, end) of a buffer: a node to be.
struct Range {
  std::size_t begin = 0, end = 0;
  int buffer = 0;
  int depth = 1;  // nodes from the root to this one, both counted
  Box4 box;
  Box4 centres;  // of the doubled centres

  std::size_t size() const { return end - begin; }
};

// A subtree: an inner node over two parts, or the nodes built by one thread, whose root is nodes[0].
struct Part {
  Box box;
  std::unique_ptr<Part> child[2];
  std::vector<BinaryNode> nodes;
};

class Builder {
 public:
  Builder(const BinnedSahOptions& options, Progress& progress, MeshView mesh);
  BinaryTree run();

 private:
  Range whole() const;
  void build_part(Part& part, const Range& range);
  void build_serial(std::vector<BinaryNode>& nodes, std::size_t self, const Range& range, SahBins& bins);
  BinaryNode make_leaf(const Range& range);

  bool is_surely_leaf(const Range& range) const;
  bool is_too_deep_for_sah(const Range& range) const;
  int bin_count(const Range& range) const;
  bool split(const Range& range, Range halves[2], SahBins& bins) const;
  void split_together(const Range& range, Range halves[2]) const;
  void split_by_index(const Range& range, Range halves[2]) const;
  void make_halves(const Range& range, const SahBins& bins, const SahSplit& split, Range halves[2]) const;

  const BinnedSahOptions& options_;
  Progress& progress_;
  TriangleRefs refs_;
  std::unique_ptr<TriangleRef[]> other_;
  TriangleRef* buffer_[2];
  Float4 unit_;
  int block_shift_;
  std::vector<std::uint32_t> order_;
  std::atomic<bool> stop_{false};
};

Builder::Builder(const BinnedSahOptions& options, Progress& progress, MeshView mesh)
    : options_(options),
      progress_(progress),
      refs_(make_triangle_refs(mesh)),
      other_(std::make_unique_for_overwrite<TriangleRef[]>(refs_.count)),
      buffer_{refs_.refs.get(), other_.get()},
      unit_(splat(refs_.unit)),
      block_shift_(std::countr_zero(static_cast<unsigned>(options.block))),
      order_(refs_.count) {
  if (!progress_.add(refs_.unseen)) stop_ = true;
}

Range Builder::whole() const {
  Range range;
  range.end = refs_.count;
  range.box = refs_.box;
  const std::size_t pieces = piece_count(range.size(), kPieceSize);
  std::vector<Box4> centres(pieces);
  for_pieces(range.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    Box4 box;
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 centre = doubled_centre(refs_.refs[i], unit_);
      box.add(centre, centre);
    }
    centres[piece] = box;
  });
  for (const Box4& box : centres) range.centres.add(box);
  return range;
}

// --- Where to split ---

// A split costs at least the test of its node, so a leaf that costs no more needs no search.
bool Builder::is_surely_leaf(const Range& range) const {
  const std::size_t blocks = (range.size() + static_cast<std::size_t>(options_.block) - 1) >> block_shift_;
  return range.size() <= static_cast<std::size_t>(options_.max_leaf) &&
         (range.size() == 1 || options_.triangle_cost * static_cast<float>(blocks) <= options_.node_cost);
}

// Halving by index takes bit_width(size - 1) more levels to get to single triangles. A SAH split may
// peel off only one triangle, so it must leave its halves that many.
bool Builder::is_too_deep_for_sah(const Range& range) const {
  return range.depth + 1 + static_cast<int>(std::bit_width(range.size() - 1)) > kMaxTreeDepth;
}

// Small ranges have no use for many bins: to search them would cost more than to fill them.
int Builder::bin_count(const Range& range) const {
  return static_cast<int>(
      std::min<std::size_t>(static_cast<std::size_t>(options_.bins), 4 + range.size() / 16));
}

// Halves the range where it lies, the left half in whole leaves or blocks.
void Builder::split_by_index(const Range& range, Range halves[2]) const {
  const auto unit = static_cast<std::size_t>(std::min(options_.block, options_.max_leaf));
  const std::size_t units = (range.size() + unit - 1) / unit;
  const std::size_t left = units > 1 ? (units + 1) / 2 * unit : (range.size() + 1) / 2;
  for (int side = 0; side < 2; ++side) {
    Range& half = halves[side];
    half.begin = side == 0 ? range.begin : range.begin + left;
    half.end = side == 0 ? range.begin + left : range.end;
    half.buffer = range.buffer;
    half.depth = range.depth + 1;
    for (std::size_t i = half.begin; i < half.end; ++i) {
      const TriangleRef& ref = buffer_[range.buffer][i];
      const Float4 centre = doubled_centre(ref, unit_);
      half.box.add(ref.lo(), ref.hi);
      half.centres.add(centre, centre);
    }
  }
}

void Builder::make_halves(const Range& range, const SahBins& bins, const SahSplit& split,
                          Range halves[2]) const {
  bins.boxes(split, halves[0].box, halves[1].box);
  const std::size_t middle = range.begin + bins.count_left(split);
  halves[0].begin = range.begin;
  halves[0].end = halves[1].begin = middle;
  halves[1].end = range.end;
  halves[0].buffer = halves[1].buffer = 1 - range.buffer;
  halves[0].depth = halves[1].depth = range.depth + 1;
}

// False if the range shall be a leaf.
bool Builder::split(const Range& range, Range halves[2], SahBins& bins) const {
  if (is_surely_leaf(range)) return false;
  const bool may_be_leaf = range.size() <= static_cast<std::size_t>(options_.max_leaf);
  if (is_too_deep_for_sah(range)) {
    if (!may_be_leaf) split_by_index(range, halves);
    return !may_be_leaf;
  }
  const BinMap map(range.centres, refs_.unit, bin_count(range));
  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  bins.clear(map.bins());
  bins.add(refs, range.size(), map);
  const SahSplit best = bins.best_split(unit_, block_shift_);
  if (may_be_leaf) {
    const std::size_t blocks = (range.size() + static_cast<std::size_t>(options_.block) - 1) >> block_shift_;
    const float area = half_area(range.box, unit_);
    const float leaf_cost = options_.triangle_cost * static_cast<float>(blocks) * area;
    if (best.axis < 0 || leaf_cost <= options_.node_cost * area + options_.triangle_cost * best.cost)
      return false;
  } else if (best.axis < 0) {
    split_by_index(range, halves);
    return true;
  }
  make_halves(range, bins, best, halves);
  TriangleRef* const target = buffer_[halves[0].buffer];
  Box4 centres[2];
  partition(refs, range.size(), map, best, target + halves[0].begin, target + halves[1].begin, centres);
  halves[0].centres = centres[0];
  halves[1].centres = centres[1];
  return true;
}

// The same for a range that is too large for a leaf, by all threads of the arena.
void Builder::split_together(const Range& range, Range halves[2]) const {
  const std::size_t pieces = piece_count(range.size(), kPieceSize);
  std::vector<SahBins> bins(pieces);
  if (pieces == 1) {
    split(range, halves, bins[0]);
    return;
  }
  const BinMap map(range.centres, refs_.unit, bin_count(range));
  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  for_pieces(range.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    bins[piece].clear(map.bins());
    bins[piece].add(refs + begin, end - begin, map);
  });
  SahBins all = bins[0];
  for (std::size_t piece = 1; piece < pieces; ++piece) all.add(bins[piece]);
  const SahSplit best = all.best_split(unit_, block_shift_);
  if (best.axis < 0 || is_too_deep_for_sah(range)) {
    split_by_index(range, halves);
    return;
  }
  make_halves(range, all, best, halves);
  std::vector<std::size_t> left_before(pieces);
  for (std::size_t piece = 1; piece < pieces; ++piece) {
    left_before[piece] = left_before[piece - 1] + bins[piece - 1].count_left(best);
  }
  std::vector<std::pair<Box4, Box4>> centres(pieces);
  TriangleRef* const target = buffer_[halves[0].buffer];
  for_pieces(range.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    Box4 both[2];
    partition(refs + begin, end - begin, map, best, target + halves[0].begin + left_before[piece],
              target + halves[1].begin + (begin - left_before[piece]), both);
    centres[piece] = {both[0], both[1]};
  });
  for (const auto& [left, right] : centres) {
    halves[0].centres.add(left);
    halves[1].centres.add(right);
  }
}

// --- The tree ---

BinaryNode Builder::make_leaf(const Range& range) {
  const TriangleRef* const refs = buffer_[range.buffer];
  for (std::size_t i = range.begin; i < range.end; ++i) order_[i] = refs[i].index();
  if (!progress_.add(range.size())) stop_.store(true, std::memory_order_relaxed);
  return {range.box.box(), static_cast<std::uint32_t>(range.begin), static_cast<std::uint32_t>(range.size())};
}

void Builder::build_serial(std::vector<BinaryNode>& nodes, std::size_t self, const Range& range,
                           SahBins& bins) {
  if (stop_.load(std::memory_order_relaxed)) return;
  Range halves[2];
  if (!split(range, halves, bins)) {
    nodes[self] = make_leaf(range);
    return;
  }
  const std::size_t first = nodes.size();
  nodes[self] = {range.box.box(), static_cast<std::uint32_t>(first), 0};
  nodes.resize(first + 2);
  build_serial(nodes, first, halves[0], bins);
  build_serial(nodes, first + 1, halves[1], bins);
}

void Builder::build_part(Part& part, const Range& range) {
  if (stop_.load(std::memory_order_relaxed)) return;
  if (range.size() <= kSubtree) {
    SahBins bins;
    part.nodes.resize(1);
    build_serial(part.nodes, 0, range, bins);
    return;
  }
  part.box = range.box.box();
  Range halves[2];
  split_together(range, halves);
  for (auto& child : part.child) child = std::make_unique<Part>();
  const auto build_half = [&](int side) {
    const DefaultFpMode guard;
    build_part(*part.child[side], halves[side]);
  };
  tbb::parallel_invoke([&] { build_half(0); }, [&] { build_half(1); });
}

// Where a part's nodes go: its root to `root`, the others from `rest` on.
struct Place {
  const Part* part;
  std::size_t root, rest;
};

// Lays out the parts depth-first, as build_serial does with its nodes: both children of a node, what is
// below the first, what is below the second. Returns the number of nodes; writes nodes of whole parts
// and leaves the others' places in `places`.
std::size_t lay_out(const Part& part, std::size_t root, std::size_t next, std::vector<Place>& places) {
  places.push_back({&part, root, next});
  if (part.child[0] == nullptr) return next + part.nodes.size() - 1;
  const std::size_t first = next;
  next = lay_out(*part.child[0], first, first + 2, places);
  return lay_out(*part.child[1], first + 1, next, places);
}

void copy_part(const Place& place, std::vector<BinaryNode>& nodes) {
  const Part& part = *place.part;
  if (part.child[0] != nullptr) {
    nodes[place.root] = {part.box, static_cast<std::uint32_t>(place.rest), 0};
    return;
  }
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    BinaryNode node = part.nodes[i];
    if (node.count == 0) node.first += static_cast<std::uint32_t>(place.rest - 1);
    nodes[i == 0 ? place.root : place.rest + i - 1] = node;
  }
}

BinaryTree Builder::run() {
  BinaryTree tree;
  tree.unseen = refs_.unseen;
  if (refs_.count != 0) {
    Part root;
    build_part(root, whole());
    progress_.throw_if_cancelled();
    std::vector<Place> places;
    tree.nodes.resize(lay_out(root, 0, 1, places));
    for_pieces(places.size(), piece_count(places.size(), 4),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) copy_part(places[i], tree.nodes);
               });
  }
  progress_.throw_if_cancelled();
  tree.order = std::move(order_);
  return tree;
}

void check_options(const BinnedSahOptions& options) {
  const auto require = [](bool holds, const char* name, double value, const char* range) {
    if (!holds) {
      throw Error("plumb: BinnedSahOptions::" + std::string(name) + " is " + std::to_string(value) +
                  "; it must be " + range);
    }
  };
  require(options.bins >= 8 && options.bins <= kMaxBins, "bins", options.bins, "8 to 32");
  require(options.max_leaf >= 1 && options.max_leaf <= 255, "max_leaf", options.max_leaf, "1 to 255");
  require(
      options.block >= 1 && options.block <= 256 && std::has_single_bit(static_cast<unsigned>(options.block)),
      "block", options.block, "a power of two up to 256");
  constexpr float kGreatest = 1e6f;
  require(options.node_cost >= 0 && options.node_cost <= kGreatest, "node_cost", options.node_cost,
          "0 to 1e6");
  require(options.triangle_cost >= 0 && options.triangle_cost <= kGreatest, "triangle_cost",
          options.triangle_cost, "0 to 1e6");
}

}  // namespace

BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress) {
  check_options(options);
  BinaryTree tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    tree = Builder(options, progress, mesh).run();
  });
  return tree;
}

}  // namespace plumb::detail
