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
#include "build/spatial_bins.h"
#include "build/tree_parts.h"
#include "build/triangle_refs.h"

// References to the triangles lie in two buffers; a split copies a range of one to the same range of
// the other, keeping the order on both sides. So the tree depends on neither threads nor pieces:
// counts, minima and maxima are the same in whatever order they are taken.
//
// Spatial splits make references more. The buffers have room for as many as the options allow, and every
// range a share of what is left of it, by the references in it: so what one part of the tree takes does not
// depend on what another has taken.
//
// Ranges above kSubtree triangles are split by all threads together and their halves become tasks; a
// smaller one is built by one thread into an array of its own.

namespace plumb::detail {
namespace {

constexpr std::size_t kSubtree = 4096;
constexpr std::size_t kPieceSize = 8192;

// Spatial splits are looked for where the boxes of the best other split overlap by more than these shares of
// the scene's and of the range's box. Stich, Friedrich and Dietrich 2009 have 1e-5 of the scene's alone:
// trees cost the same within 0.2 percent, and take twice as long.
constexpr float kLeastOverlapOfScene = 1e-4f;
constexpr float kLeastOverlapOfRange = 0.1f;

// Triangles [begin, end) of a buffer: a node to be.
struct Range {
  std::size_t begin = 0, end = 0;
  std::size_t room_end = 0;  // of the place in the buffers that it may grow into
  int buffer = 0;
  int depth = 1;  // nodes from the root to this one, both counted
  Box4 box;
  Box4 centres;  // of the doubled centres

  std::size_t size() const { return end - begin; }
  std::size_t spare() const { return room_end - end; }
};

// What the pieces of a range keep between the loops of its split; one piece where one thread does it.
struct Scratch {
  struct Piece {
    SahBins bins;
    std::size_t left_before;
    Box4 centres[2];
    SpatialBins spatial_bins;
    std::vector<TriangleRef> side[2];
    Box4 box[2];
  };
  explicit Scratch(std::size_t count) : pieces(count) {}

  std::vector<Piece> pieces;
  SahBins sum;
  SpatialBins spatial_sum;
};

std::size_t room_for(std::size_t triangles, float duplicates) {
  const auto more = static_cast<std::size_t>(static_cast<double>(triangles) * double{duplicates});
  return std::min(triangles + more, std::max(triangles, kMostTreeTriangles));
}

class Builder {
 public:
  Builder(const BinnedSahOptions& options, Progress& progress, MeshView mesh, TriangleRefs refs);
  BinaryTree run();

 private:
  bool leaf_is_cheapest(const Range& range, float cost) const;
  int bin_count(const Range& range) const;

  Range whole() const;
  bool split(const Range& range, Range halves[2], Scratch& scratch) const;
  void split_by_index(const Range& range, Range halves[2]) const;
  void set_places(const Range& range, std::size_t left, std::size_t right, Range halves[2]) const;
  SpatialSplit best_spatial_split(const Range& range, const SahSplit& best, const SahBins& bins,
                                  Scratch& scratch) const;
  bool split_spatially(const Range& range, const SpatialSplit& split, Range halves[2],
                       Scratch& scratch) const;
  const SahBins& fill_bins(const Range& range, const BinMap& map, Scratch& scratch) const;
  void move_halves(const Range& range, const BinMap& map, const SahSplit& split, Range halves[2],
                   Scratch& scratch) const;

  void build_part(TreePart& part, const Range& range);
  void build_serial(std::vector<BinaryNode>& nodes, std::size_t self, const Range& range, Scratch& scratch);
  BinaryNode make_leaf(const Range& range);
  void close_gaps(BinaryTree& tree) const;

  const BinnedSahOptions& options_;
  const SahRules rules_;
  Progress& progress_;
  MeshView mesh_;
  TriangleRefs refs_;
  std::size_t room_;  // of the buffers
  LargeArray<TriangleRef> other_;
  TriangleRef* buffer_[2];
  Float4 unit_;
  std::vector<std::uint32_t> order_;
  std::atomic<bool> stop_{false};
};

Builder::Builder(const BinnedSahOptions& options, Progress& progress, MeshView mesh, TriangleRefs refs)
    : options_(options),
      rules_(options, "BinnedSahOptions"),
      progress_(progress),
      mesh_(mesh),
      refs_(std::move(refs)),
      room_(room_for(refs_.count, options.duplicates)),
      other_(make_large_array<TriangleRef>(room_)),
      unit_(splat(refs_.unit)),
      order_(room_) {
  if (room_ != refs_.count) {
    LargeArray<TriangleRef> larger = make_large_array<TriangleRef>(room_);
    std::copy_n(refs_.refs.get(), refs_.count, larger.get());
    refs_.refs = std::move(larger);
  }
  buffer_[0] = refs_.refs.get();
  buffer_[1] = other_.get();
  stop_ = !progress_.add(refs_.unseen);
}

// --- Whether and where to split ---

// Costs are as in Wald 2007, times the area of the range's box.
bool Builder::leaf_is_cheapest(const Range& range, float cost) const {
  const float area = half_area(range.box, unit_);
  const float leaf = options_.triangle_cost * static_cast<float>(rules_.blocks(range.size())) * area;
  return leaf <= options_.node_cost * area + options_.triangle_cost * cost;
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
    const SpatialSplit spatial = best_spatial_split(range, best, bins, scratch);
    if (spatial.axis >= 0 && !(leaf_allowed && leaf_is_cheapest(range, spatial.cost)) &&
        split_spatially(range, spatial, halves, scratch)) {
      return true;
    }
    if (best.axis >= 0 && !(leaf_allowed && leaf_is_cheapest(range, best.cost))) {
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
  set_places(range, count_left, range.size() - count_left, halves);

  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  TriangleRef* const left = buffer_[1 - range.buffer] + halves[0].begin;
  TriangleRef* const right = buffer_[1 - range.buffer] + halves[1].begin;
  for_pieces(range.size(), pieces.size(), [&](std::size_t i, std::size_t begin, std::size_t end) {
    const std::size_t left_before = pieces[i].left_before;
    partition(refs + begin, end - begin, map, split, left + left_before, right + (begin - left_before),
              pieces[i].centres);
  });
  for (int side = 0; side < 2; ++side) {
    for (const Scratch::Piece& piece : pieces) halves[side].centres.add(piece.centres[side]);
  }
}

// Puts halves of so many references into the other buffer, each with its share of the room.
void Builder::set_places(const Range& range, std::size_t left, std::size_t right, Range halves[2]) const {
  const std::size_t spare = range.room_end - range.begin - (left + right);
  halves[0].begin = range.begin;
  halves[0].end = range.begin + left;
  halves[0].room_end = halves[1].begin = halves[0].end + spare * left / (left + right);
  halves[1].end = halves[1].begin + right;
  halves[1].room_end = range.room_end;
  for (int side = 0; side < 2; ++side) {
    halves[side].buffer = 1 - range.buffer;
    halves[side].depth = range.depth + 1;
  }
}

// --- Spatial splits ---

// One that is better than the best other split, if any; axis -1 if there is none.
SpatialSplit Builder::best_spatial_split(const Range& range, const SahSplit& best, const SahBins& bins,
                                         Scratch& scratch) const {
  if (range.spare() == 0) return {};
  if (best.axis >= 0) {
    Box4 left, right;
    bins.boxes(best, left, right);
    const Box4 both{max(left.lo, right.lo), min(left.hi, right.hi)};
    for (int axis = 0; axis < 3; ++axis)
      if (both.lo[axis] > both.hi[axis]) return {};
    const float overlap = half_area(both, unit_);
    if (!(overlap > kLeastOverlapOfScene * half_area(refs_.box, unit_))) return {};
    if (!(overlap > kLeastOverlapOfRange * half_area(range.box, unit_))) return {};
  }
  std::vector<Scratch::Piece>& pieces = scratch.pieces;
  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  const int count = static_cast<int>(std::min<std::size_t>(kMaxSpatialBins, 4 + range.size() / 16));
  for_pieces(range.size(), pieces.size(), [&](std::size_t i, std::size_t begin, std::size_t end) {
    pieces[i].spatial_bins.clear(range.box, count);
    pieces[i].spatial_bins.add(refs + begin, end - begin, mesh_);
  });
  SpatialSplit split;
  if (pieces.size() == 1) {
    split = pieces[0].spatial_bins.best_split(unit_, rules_.block_shift());
  } else {
    scratch.spatial_sum.clear(range.box, count);
    for (const Scratch::Piece& piece : pieces) scratch.spatial_sum.add(piece.spatial_bins);
    split = scratch.spatial_sum.best_split(unit_, rules_.block_shift());
  }
  if (best.axis >= 0 && !(split.cost < best.cost)) split.axis = -1;
  return split;
}

// False if there is not room enough, or nothing on a side.
bool Builder::split_spatially(const Range& range, const SpatialSplit& split, Range halves[2],
                              Scratch& scratch) const {
  std::vector<Scratch::Piece>& pieces = scratch.pieces;
  const TriangleRef* const refs = buffer_[range.buffer] + range.begin;
  for_pieces(range.size(), pieces.size(), [&](std::size_t i, std::size_t begin, std::size_t end) {
    Scratch::Piece& piece = pieces[i];
    for (std::vector<TriangleRef>& side : piece.side) side.clear();
    split_references(refs + begin, end - begin, split, mesh_, unit_, piece.side[0], piece.side[1]);
    for (int side = 0; side < 2; ++side) {
      piece.box[side] = piece.centres[side] = {};
      for (const TriangleRef& ref : piece.side[side]) {
        const Float4 centre = doubled_centre(ref, unit_);
        piece.box[side].add(ref.lo, ref.hi);
        piece.centres[side].add(centre, centre);
      }
    }
  });
  std::size_t count[2] = {0, 0};
  for (const Scratch::Piece& piece : pieces) {
    for (int side = 0; side < 2; ++side) count[side] += piece.side[side].size();
  }
  if (count[0] == 0 || count[1] == 0 || count[0] + count[1] > range.room_end - range.begin) return false;
  set_places(range, count[0], count[1], halves);
  for (int side = 0; side < 2; ++side) {
    TriangleRef* to = buffer_[1 - range.buffer] + halves[side].begin;
    for (const Scratch::Piece& piece : pieces) {
      to = std::copy(piece.side[side].begin(), piece.side[side].end(), to);
      halves[side].box.add(piece.box[side]);
      halves[side].centres.add(piece.centres[side]);
    }
  }
  return true;
}

// Halves the range where it lies.
void Builder::split_by_index(const Range& range, Range halves[2]) const {
  halves[0].begin = range.begin;
  halves[0].end = halves[0].room_end = halves[1].begin = range.begin + rules_.left_half(range.size());
  halves[1].end = range.end;
  halves[1].room_end = range.room_end;
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
  range.room_end = room_;
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
  // A range's room counts as its share of the triangles.
  const auto triangles = [&](std::size_t place) { return place * refs_.count / room_; };
  if (!progress_.add(triangles(range.room_end) - triangles(range.begin)))
    stop_.store(true, std::memory_order_relaxed);
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

// Puts the leaves' triangles one after the other, in the order of the nodes.
void Builder::close_gaps(BinaryTree& tree) const {
  std::vector<std::uint32_t> order;
  order.reserve(room_);
  for (BinaryNode& node : tree.nodes) {
    if (node.count == 0) continue;
    const auto first = tree.order.begin() + node.first;
    node.first = static_cast<std::uint32_t>(order.size());
    order.insert(order.end(), first, first + node.count);
  }
  order.shrink_to_fit();
  tree.order = std::move(order);
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
  if (room_ != refs_.count) close_gaps(tree);
  return tree;
}

}  // namespace

BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress) {
  require_option(options.bins >= 8 && options.bins <= kMaxBins, "BinnedSahOptions", "bins", options.bins,
                 "8 to 32");
  require_option(options.duplicates >= 0 && options.duplicates <= 1, "BinnedSahOptions", "duplicates",
                 options.duplicates, "0 to 1");
  require_tree_size(mesh.triangles.size());
  BinaryTree tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    tree = Builder(options, progress, mesh, make_triangle_refs(mesh)).run();
  });
  return tree;
}

BinaryTree build_binned_sah(TriangleRefs items, const BinnedSahOptions& options, Progress& progress) {
  return Builder(options, progress, {}, std::move(items)).run();
}

}  // namespace plumb::detail
