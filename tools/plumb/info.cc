#include "info.h"

#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>

namespace plumb::tool {
namespace {

/// "1 edge", "2 edges".
std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

class Lines {
 public:
  void heading(std::string_view text) { add("\n{}\n", text); }
  void line(std::string_view what, std::string_view value) { add("  {:<22}{}\n", what, value); }
  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }
  /// Without the last line's end.
  std::string text() && {
    text_.pop_back();
    return std::move(text_);
  }

 private:
  std::string text_;
};

void add_mesh(Lines& lines, const Info& info) {
  const Topology& t = info.topology;
  const Box& box = info.box;
  lines.line("triangles", fmt::format("{}", info.triangles));
  lines.line("  non-finite", fmt::format("{}", t.non_finite));
  lines.line("  degenerate", fmt::format("{} ({} with two equal corners)", t.degenerate, t.collapsed));
  lines.line("  duplicate", fmt::format("{}", t.duplicates));
  lines.line("vertices", fmt::format("{}", info.vertices));
  lines.line("  not used", fmt::format("{}", t.unused_vertices));
  lines.line("  at another's place", fmt::format("{}", t.repeated_vertices));
  lines.line("box", box.is_empty()
                        ? "empty"
                        : fmt::format("({}, {}, {}) to ({}, {}, {})", box.least.x, box.least.y, box.least.z,
                                      box.greatest.x, box.greatest.y, box.greatest.z));
}

std::string closed_text(const Topology& t) {
  if (t.closed()) return "yes";
  if (t.triangles == 0) return "no: there is nothing";
  return fmt::format("no: {} of {} with an odd number of triangles", counted(t.odd_edges, "edge"), t.edges);
}

std::string manifold_text(const Topology& t) {
  if (t.manifold()) return "yes";
  return fmt::format("no: {} of three triangles or more, {} where several sheets meet",
                     counted(t.non_manifold_edges, "edge"), counted(t.non_manifold_positions, "position"));
}

std::string oriented_text(const Topology& t) {
  if (t.oriented()) return "yes";
  if (t.turned_edges == 0) return "no: not manifold";
  return fmt::format("no: {} whose two triangles disagree", counted(t.turned_edges, "edge"));
}

void add_surface(Lines& lines, const Topology& t) {
  lines.heading("Surface, of the triangles with three different positions; vertices at one position are one");
  lines.line("triangles", fmt::format("{}", t.triangles));
  lines.line("positions, edges", fmt::format("{}, {}", t.positions, t.edges));
  lines.line("closed", closed_text(t));
  lines.line("manifold", manifold_text(t));
  lines.line("oriented", oriented_text(t));
  if (t.unjoined_triangles != 0) {
    lines.line("no half-edges for",
               fmt::format("{} as they are: {}{}", counted(t.unjoined_triangles, "triangle"),
                           fmt::join(t.first_unjoined, ", "),
                           t.unjoined_triangles > t.first_unjoined.size() ? ", ..." : ""));
  }
  const std::string_view apart = t.manifold() ? "" : " (of the surface taken apart where it is not manifold)";
  lines.line("components", fmt::format("{}", t.components));
  lines.line("boundary", fmt::format("{} in {}{}", counted(t.boundary_edges, "edge"),
                                     counted(t.boundary_loops, "loop"), apart));
  lines.line("Euler characteristic", fmt::format("{}{}", t.euler_characteristic, apart));
}

void add_trees(Lines& lines, const std::vector<NamedTree>& trees) {
  lines.heading("Trees");
  lines.add("  {:<8}{:>10}{:>10}{:>7}{:>7}{:>11}{:>10}{:>11}{:>8}{:>12}\n", "", "nodes", "leaves", "depth",
            "fill", "leaf fill", "SAH cost", "bytes/tri", "unseen", "build");
  for (const auto& [name, tree] : trees) {
    lines.add("  {:<8}{:>10}{:>10}{:>7}{:>5.0f} %{:>9.0f} %{:>10.1f}{:>11.1f}{:>8}{:>9.1f} ms\n", name,
              tree.nodes, tree.leaves, tree.depth, 100.0 * tree.fill, 100.0 * tree.leaf_fill, tree.sah_cost,
              bytes_per_triangle(tree), tree.unseen_triangles, 1e3 * tree.build_seconds);
  }
}

}  // namespace

Box box_of(MeshView mesh) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
  for (const glm::vec3& p : mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    box.least = glm::min(box.least, p);
    box.greatest = glm::max(box.greatest, p);
  }
  return box;
}

double bytes_per_triangle(const Statistics& tree) {
  return tree.triangles == 0 ? 0.0 : static_cast<double>(tree.bytes) / static_cast<double>(tree.triangles);
}

std::string to_text(const Info& info) {
  Lines lines;
  lines.add("{}\n", info.name);
  add_mesh(lines, info);
  add_surface(lines, info.topology);
  add_trees(lines, info.trees);
  const RasterCounts& raster = info.raster;
  lines.heading("Rasterizer, a quadtree over the screen; the scene's camera, 1280x720");
  lines.line("tiles of 32x32",
             fmt::format("{}, {} of them hidden behind what was drawn", raster.tiles, raster.tiles_hidden));
  lines.line("blocks of 4x4", fmt::format("{} tested; {} drawn, {} of them covered", raster.block_tests,
                                          raster.blocks, raster.blocks_full));
  lines.line("pixels left open", fmt::format("{}", raster.pixels_decided));
  lines.heading("Advice, for ten million rays");
  lines.add("  {}{}: {}\n", structure_kind_name(info.advice.settings.kind),
            info.advice.settings.quality == Quality::Fast ? ", built quickly" : "", info.advice.reason);
  return std::move(lines).text();
}

}  // namespace plumb::tool
