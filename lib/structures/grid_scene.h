#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "build/binary_tree.h"
#include "plumb/simd.h"
#include "trace/query.h"

namespace plumb::detail {

/// How an axis of a grid is cut into `cells` parts.
///
/// Which cell a coordinate belongs to is what index() computes; build and traversal both ask it, and as every
/// operation in it is monotonic, so is it: for x <= y, index(x) <= index(y). Where a cell begins is thereby
/// defined, if not a number that anyone computes; plane() is that to within slack(), which covers the
/// roundings of both: of (x - lo) and its product with the inverse, of the inverse itself and the step, each
/// 2^-53 of something no greater than |lo| + |hi| or the extent.
struct GridAxis {
  double lo = 0.0, hi = 0.0;
  double step = 0.0, inverse_step = 0.0;  ///< both 0 where there is one cell
  int cells = 1;

  static GridAxis cut(float lo, float hi, int cells) {
    GridAxis axis;
    axis.lo = double{lo};
    axis.hi = double{hi};
    axis.cells = cells;
    if (cells > 1) {
      axis.step = (axis.hi - axis.lo) / cells;
      axis.inverse_step = cells / (axis.hi - axis.lo);
    }
    return axis;
  }

  /// The cell of a coordinate; for one outside the nearest.
  int index(double x) const {
    return static_cast<int>(std::clamp((x - lo) * inverse_step, 0.0, static_cast<double>(cells - 1)));
  }
  /// Where cell i begins, or the one before it ends.
  double plane(int i) const { return i >= cells ? hi : lo + i * step; }
  double slack() const { return 0x1p-49 * (std::fabs(lo) + std::fabs(hi)); }
};

/// A triangle of a grid, as its lists' members are fetched.
struct GridTriangle {
  float corner[9];  ///< v0, v1, v2
  float extent;     ///< as TriangleBlock's
  std::uint32_t id;
};

/// A uniform grid with its triangles: cell (x, y, z) has those of refs[start[c]] ... refs[start[c + 1] - 1],
/// with c = (z * cells of y + y) * cells of x + x.
struct GridScene {
  GridAxis axis[3];
  Box box{};              ///< of all finite triangles
  float greatest = 0.0f;  ///< |coordinate| of these
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> refs;  ///< places in `triangles`
  std::vector<GridTriangle> triangles;

  std::size_t cell(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(axis[1].cells) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(axis[0].cells) +
           static_cast<std::size_t>(x);
  }
};

/// The queries over a GridScene, for a resolved target.
QueryTable grid_queries(Simd simd);

}  // namespace plumb::detail
