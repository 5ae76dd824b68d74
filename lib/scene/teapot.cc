#include "scene/teapot.h"

#include <cstddef>
#include <span>

#include "base/check.h"
#include "scene/mesh_builder.h"
#include "scene/teapot_data.h"

// The patches are evaluated exactly, in integers: with u = i / n and v = j / n, a point times n^6 is a sum
// of integer control points times integer Bernstein weights. So points on an edge that two patches
// share are equal without more ado, whichever patch they come from.

namespace plumb::detail {
namespace {

constexpr std::int64_t units(double value) {
  const double scaled = value * kTeapotUnits;
  return static_cast<std::int64_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
}

using Row = std::array<TeapotPoint, 4>;

TeapotPatch join(const Row& a, const Row& b, const Row& c, const Row& d) {
  TeapotPatch patch;
  std::size_t i = 0;
  for (const Row* row : {&a, &b, &c, &d}) {
    for (const TeapotPoint& p : *row) patch[i++] = p;
  }
  return patch;
}

// `quarter` counts quarter turns from +x to -y, or to +y where seen from below.
Row ring_row(const TeapotRing& ring, int quarter, bool from_below) {
  const std::int64_t r = units(ring.radius), p = units(ring.pull), z = units(ring.z);
  Row row{{{r, 0, z}, {r, -p, z}, {p, -r, z}, {0, -r, z}}};
  for (TeapotPoint& point : row) {
    for (int i = 0; i < quarter; ++i) point = {point.y, -point.x, z};
    if (from_below) point.y = -point.y;
  }
  return row;
}

// The first half lies at -y; the second goes on around the tube.
Row loop_row(const TeapotLoop& loop, bool second) {
  const std::int64_t x0 = units(loop.x0), z0 = units(loop.z0), x1 = units(loop.x1), z1 = units(loop.z1);
  const std::int64_t w = units(loop.width);
  if (second) return {{{x1, 0, z1}, {x1, w, z1}, {x0, w, z0}, {x0, 0, z0}}};
  return {{{x0, 0, z0}, {x0, -w, z0}, {x1, -w, z1}, {x1, 0, z1}}};
}

void add_rings(std::vector<TeapotPatch>& patches, std::span<const TeapotRing> rings, bool from_below) {
  for (std::size_t i = 0; i + 3 < rings.size(); i += 3) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto row = [&](std::size_t k) { return ring_row(rings[i + k], quarter, from_below); };
      patches.push_back(join(row(0), row(1), row(2), row(3)));
    }
  }
}

void add_tube(std::vector<TeapotPatch>& patches, std::span<const TeapotLoop> loops) {
  for (std::size_t i = 0; i + 3 < loops.size(); i += 3) {
    for (const bool second : {false, true}) {
      const auto row = [&](std::size_t k) { return loop_row(loops[i + k], second); };
      patches.push_back(join(row(0), row(1), row(2), row(3)));
    }
  }
}

// n^3 times the cubic Bernstein polynomials at i / n.
std::array<std::int64_t, 4> bernstein(std::int64_t i, std::int64_t n) {
  const std::int64_t j = n - i;
  return {j * j * j, 3 * j * j * i, 3 * j * i * i, i * i * i};
}

// n^6 times the patch's point at (i / n, j / n). With n up to 256 and coordinates below 2^14, the sums
// stay below 2^62.
TeapotPoint evaluate(const TeapotPatch& patch, int i, int j, int n) {
  const std::array<std::int64_t, 4> u = bernstein(i, n), v = bernstein(j, n);
  TeapotPoint sum{0, 0, 0};
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const std::int64_t weight = u[k / 4] * v[k % 4];
    sum.x += weight * patch[k].x;
    sum.y += weight * patch[k].y;
    sum.z += weight * patch[k].z;
  }
  return sum;
}

// A quad at a pole has two equal corners, and one of its triangles no area: leave that one out.
void append_unless_collapsed(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
  if (p != q && q != r && r != p) mesh.triangles.emplace_back(a, b, c);
}

}  // namespace

std::vector<TeapotPatch> teapot_patches() {
  std::vector<TeapotPatch> patches;
  add_rings(patches, kTeapotBody, false);
  add_tube(patches, kTeapotHandle);
  add_tube(patches, kTeapotSpout);
  add_rings(patches, kTeapotLid, false);
  add_rings(patches, kTeapotBottom, true);
  return patches;
}

void append_teapot(TriangleMesh& mesh, int segments, const glm::dvec3& foot, double scale) {
  PLUMB_CHECK_LE(1, segments);
  PLUMB_CHECK_LE(segments, kMaxTeapotSegments);
  const double n = segments;
  const double unit = scale / ((n * n * n) * (n * n * n) * kTeapotUnits);
  const std::uint32_t row = static_cast<std::uint32_t>(segments) + 1;
  for (const TeapotPatch& patch : teapot_patches()) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= segments; ++i) {
      for (int j = 0; j <= segments; ++j) {
        const TeapotPoint p = evaluate(patch, i, j, segments);
        append_vertex(mesh,
                      {foot.x + static_cast<double>(p.y) * unit, foot.y + static_cast<double>(p.z) * unit,
                       foot.z + static_cast<double>(p.x) * unit});
      }
    }
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        const std::uint32_t a = first + i * row + j;
        append_unless_collapsed(mesh, a, a + row, a + row + 1);
        append_unless_collapsed(mesh, a, a + row + 1, a + 1);
      }
    }
  }
}

}  // namespace plumb::detail
