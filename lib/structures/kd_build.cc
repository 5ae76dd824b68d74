#include "structures/kd_build.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <string>
#include <utility>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "base/fp_mode.h"
#include "build/box.h"
#include "build/clip_triangle.h"
#include "plumb/error.h"
#include "structures/kd_events.h"

namespace plumb::detail {
namespace {

// A cell of so many triangles is built by one thread, larger ones by tasks.
constexpr std::size_t kSubtree = 1 << 13;

constexpr int kLanesLog2 = std::countr_zero(static_cast<unsigned>(kKdLanes));

struct Cell {
  Box box;
  int depth = 1;           // cells from the root to this one, both counted
  std::size_t count = 0;   // triangles
  std::size_t budget = 0;  // references that splitting may add
  std::size_t steps = 0;   // of Progress, done when its last leaf is
  KdEvents events[3];
};

// A subtree's nodes and references, counted from its own beginning.
struct Part {
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> order;
};

class Builder {
 public:
  Builder(MeshView mesh, const KdBuildOptions& options, Progress& progress)
      : mesh_(mesh),
        options_(options),
        costs_{options.node_cost, options.block_cost, options.empty_factor, kLanesLog2},
        progress_(progress) {}

  KdTreeParts run();

 private:
  Triangle triangle(std::uint32_t index) const {
    const glm::uvec3& corners = mesh_.triangles[index];
    return {mesh_.positions[corners.x], mesh_.positions[corners.y], mesh_.positions[corners.z]};
  }
  Cell root(std::size_t& unseen) const;
  KdPlane choose(const Cell& cell) const;
  void split(Cell& cell, const KdPlane& plane, KdSide* side, Cell halves[2]) const;
  void make_leaf(const Cell& cell, Part& part);
  void build_serial(Cell cell, Part& part, KdSide* side);
  void build_tasks(Cell cell, Part& part);

  MeshView mesh_;
  const KdBuildOptions& options_;
  const KdCosts costs_;
  Progress& progress_;
  std::atomic<bool> stop_{false};
};

// Calls work(axis) for the three of them, at once for large cells.
template <typename Work>
void for_axes(std::size_t count, const Work& work) {
  if (count <= kSubtree) {
    for (int axis = 0; axis < 3; ++axis) work(axis);
    return;
  }
  tbb::parallel_for(0, 3, [&](int axis) {
    const DefaultFpMode guard;
    work(axis);
  });
}

Cell Builder::root(std::size_t& unseen) const {
  Cell cell;
  cell.box = empty_box();
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const Triangle t = triangle(index);
    if (!triangle_is_finite(t)) continue;
    const Box box = box_of(t);
    for (int axis = 0; axis < 3; ++axis) {
      cell.box.lo[axis] = std::min(cell.box.lo[axis], box.lo[axis]);
      cell.box.hi[axis] = std::max(cell.box.hi[axis], box.hi[axis]);
      add_events(cell.events[axis], box, axis, index);
    }
    ++cell.count;
  }
  unseen = mesh_.triangles.size() - cell.count;
  for_axes(cell.count, [&](int axis) { std::sort(cell.events[axis].begin(), cell.events[axis].end()); });
  // References and nodes are counted in 30 bits, and the constant lets small scenes be split at all.
  constexpr double kMost = 1 << 29;
  cell.budget =
      static_cast<std::size_t>(std::min(options_.most_added * static_cast<double>(cell.count) + 64.0, kMost));
  cell.steps = cell.count;
  return cell;
}

// The plane to cut the cell at, with axis -1 if it shall be a leaf.
KdPlane Builder::choose(const Cell& cell) const {
  const KdPlane none;
  if (cell.count == 0 || cell.depth >= options_.max_depth) return none;
  KdPlane planes[3];
  for_axes(cell.count, [&](int axis) {
    planes[axis] = sweep_planes(cell.events[axis], cell.count, axis, cell.box, costs_);
  });
  const KdPlane& best = *std::min_element(planes, planes + 3,
                                          [](const KdPlane& a, const KdPlane& b) { return a.cost < b.cost; });
  if (!(best.cost < costs_.leaf(cell.count))) return none;
  if (best.below + best.above - cell.count > cell.budget) return none;
  return best;
}

// Takes the cell's events.
void Builder::split(Cell& cell, const KdPlane& plane, KdSide* side, Cell halves[2]) const {
  classify(cell.events[plane.axis], plane, side);
  for (const int half : {0, 1}) {
    halves[half].box = cell.box;
    halves[half].depth = cell.depth + 1;
  }
  halves[0].box.hi[plane.axis] = plane.place;
  halves[1].box.lo[plane.axis] = plane.place;

  KdEvents fresh[3][2];          // of triangles that are cut, by axis and half
  std::size_t kept[2] = {0, 0};  // triangles that are not
  for (const KdEvent& event : cell.events[plane.axis]) {
    if (!event.begins()) continue;
    const std::uint32_t index = event.triangle();
    if (side[index] != KdSide::Both) {
      ++kept[side[index] == KdSide::Below ? 0 : 1];
      continue;
    }
    const Triangle t = triangle(index);
    for (const int half : {0, 1}) {
      Box box;
      if (!clip_triangle(t, halves[half].box, box)) continue;
      ++halves[half].count;
      for (int axis = 0; axis < 3; ++axis) add_events(fresh[axis][half], box, axis, index);
    }
  }
  for (const int half : {0, 1}) halves[half].count += kept[half];
  for_axes(cell.count, [&](int axis) {
    for (KdEvents& events : fresh[axis]) std::sort(events.begin(), events.end());
    KdEvents to[2];
    split_events(cell.events[axis], side, kept, fresh[axis], to);
    KdEvents().swap(cell.events[axis]);
    halves[0].events[axis] = std::move(to[0]);
    halves[1].events[axis] = std::move(to[1]);
  });

  // Shared out by triangles. Cutting a triangle may have lost it on a side, so that less was added than
  // expected.
  const std::size_t both = halves[0].count + halves[1].count;
  const std::size_t left = cell.budget - (both > cell.count ? both - cell.count : 0);
  const double share = both == 0 ? 0.0 : static_cast<double>(halves[0].count) / static_cast<double>(both);
  halves[0].budget = static_cast<std::size_t>(share * static_cast<double>(left));
  halves[1].budget = left - halves[0].budget;
  halves[0].steps = static_cast<std::size_t>(share * static_cast<double>(cell.steps));
  halves[1].steps = cell.steps - halves[0].steps;
}

void Builder::make_leaf(const Cell& cell, Part& part) {
  const std::size_t first = part.order.size();
  part.nodes.push_back(
      KdNode::leaf(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(cell.count)));
  for (const KdEvent& event : cell.events[0]) {
    if (event.begins()) part.order.push_back(event.triangle());
  }
  std::sort(part.order.begin() + static_cast<std::ptrdiff_t>(first), part.order.end());
  bool goes_on = false;
  try {
    goes_on = progress_.add(cell.steps);
  } catch (...) {
    stop_.store(true, std::memory_order_relaxed);
    throw;
  }
  if (!goes_on) stop_.store(true, std::memory_order_relaxed);
}

void Builder::build_serial(Cell cell, Part& part, KdSide* side) {
  if (stop_.load(std::memory_order_relaxed)) return;
  const KdPlane plane = choose(cell);
  if (plane.axis < 0) {
    make_leaf(cell, part);
    return;
  }
  Cell halves[2];
  split(cell, plane, side, halves);
  const std::size_t self = part.nodes.size();
  part.nodes.push_back(KdNode::inner(plane.axis, plane.place, 0));
  build_serial(std::move(halves[0]), part, side);
  part.nodes[self] = KdNode::inner(plane.axis, plane.place, static_cast<std::uint32_t>(part.nodes.size()));
  build_serial(std::move(halves[1]), part, side);
}

// The nodes of `from` behind those of `to`.
void append(Part& to, const Part& from) {
  const auto nodes = static_cast<std::uint32_t>(to.nodes.size());
  const auto order = static_cast<std::uint32_t>(to.order.size());
  for (const KdNode& node : from.nodes) {
    to.nodes.push_back(node.is_leaf() ? KdNode::leaf(order + node.first(), node.count())
                                      : KdNode::inner(node.axis(), node.plane(), nodes + node.upper()));
  }
  to.order.insert(to.order.end(), from.order.begin(), from.order.end());
}

// Yields the nodes that build_serial would.
void Builder::build_tasks(Cell cell, Part& part) {
  // Its own, for a thread that waits for a part of its work may take up another cell meanwhile.
  const auto side = std::make_unique_for_overwrite<KdSide[]>(mesh_.triangles.size());
  if (cell.count <= kSubtree) {
    build_serial(std::move(cell), part, side.get());
    return;
  }
  if (stop_.load(std::memory_order_relaxed)) return;
  const KdPlane plane = choose(cell);
  if (plane.axis < 0) {
    make_leaf(cell, part);
    return;
  }
  Cell halves[2];
  split(cell, plane, side.get(), halves);
  Part parts[2];
  const auto build_half = [&](int half) {
    const DefaultFpMode guard;
    build_tasks(std::move(halves[half]), parts[half]);
  };
  tbb::parallel_invoke([&] { build_half(0); }, [&] { build_half(1); });
  part.nodes.push_back(
      KdNode::inner(plane.axis, plane.place, static_cast<std::uint32_t>(1 + parts[0].nodes.size())));
  append(part, parts[0]);
  append(part, parts[1]);
}

KdTreeParts Builder::run() {
  KdTreeParts tree;
  Cell cell = root(tree.unseen);
  tree.box = cell.box;
  tree.greatest = greatest_coordinate(cell.box);
  progress_.add(tree.unseen);
  progress_.throw_if_cancelled();
  if (cell.count == 0) return tree;
  Part part;
  build_tasks(std::move(cell), part);
  progress_.throw_if_cancelled();
  constexpr std::size_t kMostNodes = std::size_t{1} << 30;
  if (part.nodes.size() > kMostNodes) throw Error("plumb: KdTree: too many cells; split the mesh");
  tree.nodes = std::move(part.nodes);
  tree.order = std::move(part.order);
  return tree;
}

}  // namespace

KdTreeParts build_kd_tree(MeshView mesh, const KdBuildOptions& options, Progress& progress) {
  constexpr std::size_t kMost = std::size_t{1} << 28;
  if (mesh.triangles.size() >= kMost) {
    throw Error("plumb: KdTree: " + std::to_string(mesh.triangles.size()) +
                " triangles are too many for one tree; split the mesh into parts below " +
                std::to_string(kMost));
  }
  KdTreeParts tree;
  in_arena(options.threads, [&] {
    const DefaultFpMode guard;
    tree = Builder(mesh, options, progress).run();
  });
  return tree;
}

}  // namespace plumb::detail
