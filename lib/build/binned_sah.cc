#include "build/binned_sah.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <oneapi/tbb/parallel_invoke.h>

#include "base/fp_mode.h"
#include "build/chunks.h"
#include "build/sah_bins.h"
#include "build/tree_parts.h"
#include "build/triangle_refs.h"

// References to the triangles lie in two buffers; a split copies a range of one to the same range of
// the other, keeping the order on both sides. So the tree depends on neither threads nor pieces:
// counts, minima and maxima are the same in whatever order they are taken.
//
// Ranges above kSubtree triangles are split by all threads together and their halves become tasks; a
// smaller one is built by one thread into an array of its own.

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

// What the pieces of a range keep between the loops of its split; one piece where one thread does it.
struct Scratch {
  struct Piece {
    SahBins bins;
    std::size_t left_before;
    Box4 centres[2];
  };
  explicit Scratch(std::size_t count) : pieces(count) {}

  std::vector<Piece> pieces;
  SahBins sum;
};

class Builder {
 public:
  Builder(const BinnedSahOptions& options, Progress& progress, TriangleRefs refs);
  BinaryTree run();

 private:
  bool leaf_is_cheapest(const Range& range, const SahSplit& split) const;
  int bin_count(const Range& range) const;

  Range whole() const;
  bool split(const Range& range, Range halves[2], Scratch& scratch) const;
  void split_by_index(const Range& range, Range halves[2]) const;
  const SahBins& fill_bins(const Range& range, const BinMap& map, Scratch& scratch) const;
  void move_halves(const Range& range, const BinMap& map, const SahSplit& split, Range halves[2],
                   Scratch& scratch) const;

  void build_part(TreePart& part, const Range& range);
  void build_serial(std::vector<BinaryNode>& nodes, std::size_t self, const Range& range, Scratch& scratch);
  BinaryNode make_leaf(const Range& range);

  const BinnedSahOptions& options_;
  const SahRules rules_;
  Progress& progress_;
  TriangleRefs refs_;
  LargeArray<TriangleRef> other_;
  TriangleRef* buffer_[2];
  Float4 unit_;
  std::vector<std::uint32_t> order_;
  std::atomic<bool> stop_{false};
};

Builder::Builder(const BinnedSahOptions& options, Progress& progress, TriangleRefs refs)
    : options_(options),
      rules_(options, "BinnedSahOptions"),
      progress_(progress),
      refs_(std::move(refs)),
      other_(make_large_array<TriangleRef>(refs_.count)),
      buffer_{refs_.refs.get(), other_.get()},
      unit_(splat(refs_.unit)),
      order_(refs_.count) {
  stop_ = !progress_.add(refs_.unseen);
}

// --- Whether and where to split ---

// Costs are as in Wald 2007, times the area of the range's box.
bool Builder::leaf_is_cheapest(const Range& range, const SahSplit& split) const {
  const float area = half_area(range.box, unit_);
  const float leaf = options_.triangle_cost * static_cast<float>(rules_.blocks(range.size())) * area;
  return split.axis < 0 || leaf <= options_.node_cost * area + options_.triangle_cost * split.cost;
}

// Small ranges have no use for many bins: to search them would take longer than to fill them.
int Builder::bin_count(const Range& range) const {
  return static_cast<int>(
      std::min<std::size_t>(static_cast<std::size_t>(options_.bins), 4 + range.size() / 16));
}

// False if the range shall be a leaf.
bool Builder::split(const Range& range, Range halves[2], Scratch& scratch) const {
  if (rules_.is_leaf_unsearched(range.size())) return false;
  const bool leaf_allowed = rules_.may_be_leaf(range.size());
  if (!rules_.must_be_halved(range.size(), range.depth)) {
    const BinMap map(range.centres, refs_.unit, bin_count(range));
    const SahBins& bins = fill_bins(range, map, scratch);
    const SahSplit best = bins.best_split(unit_, rules_.block_shift());
    if (best.axis >= 0 && !(leaf_allowed && leaf_is_cheapest(range, best))) {
      bins.boxes(best, halves[0].box, halves[1].box);
      move_halves(range, map, best, halves, scratch);
      return true;
    }
  }
  if (leaf_allowed) return false;
  split_by_index(range, halves);
  return true;
}

const SahBins& Builder::fill_bins(const Range& range, const BinMap& map, Scratch& scratch) const {
  std::vector<Scratch::Piece>& pieces = scratch.pieces;
  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  for_pieces(range.size(), pieces.size(), [&](std::size_t i, std::size_t begin, std::size_t end) {
    pieces[i].bins.clear(map.bins());
    pieces[i].bins.add(refs + begin, end - begin, map);
  });
  if (pieces.size() == 1) return pieces[0].bins;
  scratch.sum.clear(map.bins());
  for (const Scratch::Piece& piece : pieces) scratch.sum.add(piece.bins);
  return scratch.sum;
}

// Sets all of the halves but their boxes.
void Builder::move_halves(const Range& range, const BinMap& map, const SahSplit& split, Range halves[2],
                          Scratch& scratch) const {
  std::vector<Scratch::Piece>& pieces = scratch.pieces;
  std::size_t count_left = 0;
  for (Scratch::Piece& piece : pieces) {
    piece.left_before = count_left;
    count_left += piece.bins.count_left(split);
  }
  halves[0].begin = range.begin;
  halves[0].end = halves[1].begin = range.begin + count_left;
  halves[1].end = range.end;

  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  TriangleRef* const left = buffer_[1 - range.buffer] + halves[0].begin;
  TriangleRef* const right = buffer_[1 - range.buffer] + halves[1].begin;
  for_pieces(range.size(), pieces.size(), [&](std::size_t i, std::size_t begin, std::size_t end) {
    const std::size_t left_before = pieces[i].left_before;
    partition(refs + begin, end - begin, map, split, left + left_before, right + (begin - left_before),
              pieces[i].centres);
  });
  for (int side = 0; side < 2; ++side) {
    halves[side].buffer = 1 - range.buffer;
    halves[side].depth = range.depth + 1;
    for (const Scratch::Piece& piece : pieces) halves[side].centres.add(piece.centres[side]);
  }
}

// Halves the range where it lies.
void Builder::split_by_index(const Range& range, Range halves[2]) const {
  halves[0].begin = range.begin;
  halves[0].end = halves[1].begin = range.begin + rules_.left_half(range.size());
  halves[1].end = range.end;
  for (int side = 0; side < 2; ++side) {
    Range& half = halves[side];
    half.buffer = range.buffer;
    half.depth = range.depth + 1;
    for (std::size_t i = half.begin; i < half.end; ++i) {
      const TriangleRef& ref = buffer_[range.buffer][i];
      const Float4 centre = doubled_centre(ref, unit_);
      half.box.add(ref.lo, ref.hi);
      half.centres.add(centre, centre);
    }
  }
}

// --- The tree ---

Range Builder::whole() const {
  Range range;
  range.end = refs_.count;
  range.box = refs_.box;
  std::vector<Box4> centres(piece_count(range.size(), kPieceSize));
  for_pieces(range.size(), centres.size(), [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 centre = doubled_centre(refs_.refs[i], unit_);
      centres[piece].add(centre, centre);
    }
  });
  for (const Box4& box : centres) range.centres.add(box);
  return range;
}

BinaryNode Builder::make_leaf(const Range& range) {
  const TriangleRef* const refs = buffer_[range.buffer];
  for (std::size_t i = range.begin; i < range.end; ++i) order_[i] = refs[i].index();
  if (!progress_.add(range.size())) stop_.store(true, std::memory_order_relaxed);
  return {range.box.box(), static_cast<std::uint32_t>(range.begin), static_cast<std::uint32_t>(range.size())};
}

void Builder::build_serial(std::vector<BinaryNode>& nodes, std::size_t self, const Range& range,
                           Scratch& scratch) {
  if (stop_.load(std::memory_order_relaxed)) return;
  Range halves[2];
  if (!split(range, halves, scratch)) {
    nodes[self] = make_leaf(range);
    return;
  }
  const std::size_t first = nodes.size();
  nodes[self] = {range.box.box(), static_cast<std::uint32_t>(first), 0};
  nodes.resize(first + 2);
  build_serial(nodes, first, halves[0], scratch);
  build_serial(nodes, first + 1, halves[1], scratch);
}

void Builder::build_part(TreePart& part, const Range& range) {
  if (stop_.load(std::memory_order_relaxed)) return;
  if (range.size() <= kSubtree) {
    Scratch scratch(1);
    part.nodes.resize(1);
    build_serial(part.nodes, 0, range, scratch);
    return;
  }
  part.box = range.box.box();
  Range halves[2];
  {
    Scratch scratch(piece_count(range.size(), kPieceSize));
    split(range, halves, scratch);  // no leaf: it is larger than any may be
  }
  const auto build_half = [&](int side) {
    const DefaultFpMode guard;
    part.child[side] = std::make_unique<TreePart>();
    build_part(*part.child[side], halves[side]);
  };
  tbb::parallel_invoke([&] { build_half(0); }, [&] { build_half(1); });
}

BinaryTree Builder::run() {
  BinaryTree tree;
  tree.unseen = refs_.unseen;
  if (refs_.count != 0) {
    TreePart root;
    build_part(root, whole());
    progress_.throw_if_cancelled();
    tree.nodes = join_parts(root);
  }
  progress_.throw_if_cancelled();
  tree.order = std::move(order_);
  return tree;
}

}  // namespace

BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress) {
  require_option(options.bins >= 8 && options.bins <= kMaxBins, "BinnedSahOptions", "bins", options.bins,
                 "8 to 32");
  require_tree_size(mesh.triangles.size());
  BinaryTree tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    tree = build_binned_sah(make_triangle_refs(mesh), options, progress);
  });
  return tree;
}

BinaryTree build_binned_sah(TriangleRefs items, const BinnedSahOptions& options, Progress& progress) {
  return Builder(options, progress, std::move(items)).run();
}

}  // namespace plumb::detail
