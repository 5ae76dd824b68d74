#include "structures/grid_build.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "build/box.h"
#include "exact/intersect.h"
#include "wide/triangle_block.h"

namespace plumb::detail {
namespace {

constexpr double kMostCells = 0x1p28;
constexpr int kMostCellsOfAxis = 1 << 20;
constexpr double kMostReferences = 32.0;  // a triangle, before planes are asked
constexpr std::size_t kPiece = 4096;      // triangles

Triangle triangle_of(const GridTriangle& t) {
  const float* c = t.corner;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
}

// The cells that a triangle's box meets.
struct CellRange {
  int lo[3], hi[3];

  double count() const { return (hi[0] - lo[0] + 1.0) * (hi[1] - lo[1] + 1.0) * (hi[2] - lo[2] + 1.0); }
};

CellRange range_of(const GridAxis axis[3], const GridTriangle& t) {
  CellRange range;
  for (int a = 0; a < 3; ++a) {
    const float x = t.corner[a], y = t.corner[3 + a], z = t.corner[6 + a];
    range.lo[a] = axis[a].index(double{std::min({x, y, z})});
    range.hi[a] = axis[a].index(double{std::max({x, y, z})});
  }
  return range;
}

// Whether a triangle's plane passes a box, with its corners at middle +- half.
//
// With n = e1 x e2, a point of the plane in the box has n.(middle - v0) within sum |n_k| half_k of 0. In
// double, n is off by 4 u L^2 in each component (exact/double_stage.h), the differences and products by a few
// u of themselves; all of it is below 2^-46 (|n|_1 + L^2) (|middle - v0|_max + half_max) and far below the
// slack taken.
class PlaneTest {
 public:
  explicit PlaneTest(const Triangle& t) : v0_(t.v0) {
    double e1[3], e2[3];
    for (int a = 0; a < 3; ++a) {
      e1[a] = double{t.v1[a]} - double{t.v0[a]};
      e2[a] = double{t.v2[a]} - double{t.v0[a]};
    }
    n_[0] = e1[1] * e2[2] - e1[2] * e2[1];
    n_[1] = e1[2] * e2[0] - e1[0] * e2[2];
    n_[2] = e1[0] * e2[1] - e1[1] * e2[0];
    const auto norm = [](const double* e) { return (std::fabs(e[0]) + std::fabs(e[1])) + std::fabs(e[2]); };
    const double length = std::max(norm(e1), norm(e2));
    slack_ = 0x1p-40 * (norm(n_) + length * length);
  }

  bool meets(const double middle[3], const double half[3]) const {
    double distance = 0.0, reach = 0.0, size = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double offset = middle[a] - double{v0_[a]};
      distance += n_[a] * offset;
      reach += std::fabs(n_[a]) * half[a];
      size = std::max(size, std::fabs(offset) + half[a]);
    }
    return !(std::fabs(distance) > reach + slack_ * size);
  }

 private:
  glm::vec3 v0_;
  double n_[3];
  double slack_;
};

// Calls visit(cell) for each cell that the triangle is listed in. A plane leaves out cells only of ranges of
// 28 and more: for the 8 that a small triangle mostly has, asking takes more than the references that it
// spares (a third of a build; a tenth of the references).
template <typename Visit>
void for_each_cell(const GridScene& grid, const GridTriangle& t, const Visit& visit) {
  const CellRange range = range_of(grid.axis, t);
  const auto all = [&](const auto& wanted) {
    for (int z = range.lo[2]; z <= range.hi[2]; ++z) {
      for (int y = range.lo[1]; y <= range.hi[1]; ++y) {
        for (int x = range.lo[0]; x <= range.hi[0]; ++x) {
          if (wanted(x, y, z)) visit(grid.cell(x, y, z));
        }
      }
    }
  };
  if (range.count() < 28.0) {
    all([](int, int, int) { return true; });
    return;
  }
  const PlaneTest plane(triangle_of(t));
  all([&](int x, int y, int z) {
    const int index[3] = {x, y, z};
    double middle[3], half[3];
    for (int a = 0; a < 3; ++a) {
      const double from = grid.axis[a].plane(index[a]), to = grid.axis[a].plane(index[a] + 1);
      middle[a] = 0.5 * (from + to);
      half[a] = 0.5 * (to - from) + 2.0 * grid.axis[a].slack();
    }
    return plane.meets(middle, half);
  });
}

// Copies the finite triangles and takes their box.
void add_triangles(GridScene& grid, MeshView mesh, std::uint32_t first_id) {
  grid.box = empty_box();
  grid.triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    const Triangle t{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
    if (!triangle_is_finite(t)) continue;
    grid.triangles.push_back({{t.v0.x, t.v0.y, t.v0.z, t.v1.x, t.v1.y, t.v1.z, t.v2.x, t.v2.y, t.v2.z},
                              triangle_extent(t.v0, t.v1, t.v2),
                              first_id + static_cast<std::uint32_t>(i)});
    for (const glm::vec3& p : {t.v0, t.v1, t.v2}) {
      for (int a = 0; a < 3; ++a) {
        grid.box.lo[a] = std::min(grid.box.lo[a], p[a]);
        grid.box.hi[a] = std::max(grid.box.hi[a], p[a]);
      }
    }
  }
  grid.greatest = greatest_coordinate(grid.box);
}

// About `cells` cubes, or squares or lengths where the box is flat: an axis whose extent is less than a
// cube's side gets one cell, and the others share the cells.
std::array<int, 3> resolution(const Box& box, double cells) {
  double extent[3];
  for (int a = 0; a < 3; ++a) extent[a] = double{box.hi[a]} - double{box.lo[a]};
  std::array<int, 3> result{1, 1, 1};
  bool cut[3] = {extent[0] > 0.0, extent[1] > 0.0, extent[2] > 0.0};
  for (int round = 0; round < 3; ++round) {
    // log2 of the side, as extents of floats may be so large that their product overflows.
    double log_volume = 0.0;
    int dimensions = 0;
    for (int a = 0; a < 3; ++a) {
      if (!cut[a]) continue;
      log_volume += std::log2(extent[a]);
      ++dimensions;
    }
    if (dimensions == 0) break;
    const double log_side = (log_volume - std::log2(std::max(cells, 1.0))) / dimensions;
    bool changed = false;
    for (int a = 0; a < 3; ++a) {
      if (!cut[a]) continue;
      const double count = std::exp2(std::log2(extent[a]) - log_side);
      result[static_cast<std::size_t>(a)] =
          static_cast<int>(std::clamp(count, 1.0, static_cast<double>(kMostCellsOfAxis)));
      if (count < 1.0) {
        cut[a] = false;
        changed = true;
      }
    }
    if (!changed) break;
  }
  return result;
}

void cut(GridScene& grid, double cells) {
  const std::array<int, 3> counts = resolution(grid.box, std::min(cells, kMostCells));
  for (int a = 0; a < 3; ++a) {
    const std::size_t i = static_cast<std::size_t>(a);
    grid.axis[i] = GridAxis::cut(grid.box.lo[a], grid.box.hi[a], counts[i]);
  }
}

double box_references(const GridScene& grid) {
  double count = 0.0;
  for (const GridTriangle& t : grid.triangles) count += range_of(grid.axis, t).count();
  return count;
}

// Halves the cells' number until the triangles' boxes meet few enough.
void choose_cells(GridScene& grid, double cells_per_triangle) {
  const auto triangles = static_cast<double>(grid.triangles.size());
  double cells = std::max(1.0, cells_per_triangle * triangles);
  cut(grid, cells);
  while (cells > 1.0 && box_references(grid) > kMostReferences * triangles + 1024.0) {
    cells *= 0.25;
    cut(grid, cells);
  }
}

// Puts the triangles in the order of their rows of cells, so that the lists that one after another goes to,
// and the triangles that a ray comes upon, are near each other in memory.
void order_by_row(GridScene& grid) {
  const GridAxis &y = grid.axis[1], &z = grid.axis[2];
  const auto row_of = [&](const GridTriangle& t) {
    return static_cast<std::size_t>(z.index(double{t.corner[2]})) * static_cast<std::size_t>(y.cells) +
           static_cast<std::size_t>(y.index(double{t.corner[1]}));
  };
  std::vector<std::uint32_t> row(grid.triangles.size());
  std::vector<std::uint32_t> place(static_cast<std::size_t>(y.cells) * static_cast<std::size_t>(z.cells) + 1,
                                   0);
  for (std::size_t i = 0; i < row.size(); ++i) {
    row[i] = static_cast<std::uint32_t>(row_of(grid.triangles[i]));
    ++place[row[i] + 1];
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<GridTriangle> ordered(grid.triangles.size());
  for (std::size_t i = 0; i < row.size(); ++i) ordered[place[row[i]]++] = grid.triangles[i];
  grid.triangles = std::move(ordered);
}

// A counting sort: how many each cell gets, where its list ends, then the lists from their ends. The cells
// that a triangle goes to are written down when they are counted, so that planes are asked once.
void fill(GridScene& grid, Progress& progress) {
  const std::size_t cells = static_cast<std::size_t>(grid.axis[0].cells) *
                            static_cast<std::size_t>(grid.axis[1].cells) *
                            static_cast<std::size_t>(grid.axis[2].cells);
  grid.start.assign(cells + 1, 0);
  std::vector<std::uint32_t> cell_of;                             // of every reference, triangle by triangle
  std::vector<std::size_t> end_of(grid.triangles.size() + 1, 0);  // of a triangle's references
  cell_of.reserve(8 * grid.triangles.size());
  for (std::size_t i = 0; i < grid.triangles.size(); ++i) {
    for_each_cell(grid, grid.triangles[i], [&](std::size_t cell) {
      ++grid.start[cell];
      cell_of.push_back(static_cast<std::uint32_t>(cell));
    });
    end_of[i + 1] = cell_of.size();
    if (i % kPiece == 0 && !progress.add(std::min(kPiece, grid.triangles.size() - i))) break;
  }
  progress.throw_if_cancelled();
  std::partial_sum(grid.start.begin(), grid.start.end(), grid.start.begin());
  grid.refs.resize(cell_of.size());
  for (std::size_t i = grid.triangles.size(); i-- > 0;) {
    for (std::size_t k = end_of[i]; k < end_of[i + 1]; ++k)
      grid.refs[--grid.start[cell_of[k]]] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace

GridScene build_grid(MeshView mesh, const GridBuildOptions& options, Progress& progress) {
  GridScene grid;
  add_triangles(grid, mesh, options.first_id);
  if (grid.triangles.empty()) return grid;
  choose_cells(grid, options.cells_per_triangle);
  order_by_row(grid);
  fill(grid, progress);
  return grid;
}

}  // namespace plumb::detail
