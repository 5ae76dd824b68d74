#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "help.h"
#include "output_file.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "plumb/topology.h"
#include "plumb/version.h"
#include "progress_bar.h"
#include "scene.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

struct InfoOptions {
  std::string scene = "builtin:teapot-in-stadium";
  int width = 0;
  int threads = 0;
  bool json = false;
};

struct Box {
  glm::vec3 least, greatest;
  bool is_empty() const { return !(least.x <= greatest.x); }
};

/// Around the finite vertices.
Box box_of(const TriangleMesh& mesh) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
  for (const glm::vec3& p : mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    box.least = glm::min(box.least, p);
    box.greatest = glm::max(box.greatest, p);
  }
  return box;
}

struct Info {
  std::string name;
  std::size_t vertices, triangles;
  Box box;
  Topology topology;
  std::vector<Statistics> trees;
};

Info look_at(const InfoOptions& options) {
  const TriangleMesh mesh = open_mesh(options.scene);
  Info info{options.scene, mesh.positions.size(), mesh.triangles.size(), box_of(mesh), {}, {}};
  info.topology = topology(mesh, progress_bar("topology"));
  for (const int width : {2, 4, 8}) {
    if (options.width != 0 && options.width != width) continue;
    BuildOptions build;
    build.width = width;
    build.threads = options.threads;
    build.progress = progress_bar(fmt::format("bvh{}: build", width));
    info.trees.push_back(Bvh(mesh, build).statistics());
  }
  return info;
}

std::string yes_or(bool yes, const std::string& otherwise) { return yes ? "yes" : otherwise; }

/// "1 edge", "2 edges".
std::string counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string mesh_text(const Info& info) {
  const Topology& t = info.topology;
  std::string text = fmt::format("{}\n", info.name);
  const auto line = [&](const char* what, const std::string& value) {
    text += fmt::format("  {:<22}{}\n", what, value);
  };
  line("triangles", fmt::format("{}", info.triangles));
  line("vertices", fmt::format("{} ({} not used, {} at the place of another)", info.vertices,
                               t.unused_vertices, t.repeated_vertices));
  line("box", info.box.is_empty() ? "empty"
                                  : fmt::format("({}, {}, {}) to ({}, {}, {})", info.box.least.x,
                                                info.box.least.y, info.box.least.z, info.box.greatest.x,
                                                info.box.greatest.y, info.box.greatest.z));
  line("non-finite triangles", fmt::format("{}", t.non_finite));
  line("degenerate triangles", fmt::format("{} ({} with two equal corners)", t.degenerate, t.collapsed));
  line("duplicate triangles", fmt::format("{}", t.duplicates));
  line("closed", yes_or(t.closed(), t.triangles == 0 ? "no"
                                                     : "no: " + counted(t.odd_edges, "edge") + " of " +
                                                           fmt::format("{}", t.edges) +
                                                           " with an odd number of triangles"));
  line("manifold", yes_or(t.manifold(),
                          "no: " + counted(t.non_manifold_edges, "edge") + " of three triangles or more, " +
                              counted(t.non_manifold_positions, "position") + " where several sheets meet"));
  line("oriented", yes_or(t.oriented(), t.turned_edges == 0 ? "no: not manifold"
                                                            : "no: " + counted(t.turned_edges, "edge") +
                                                                  " whose two triangles disagree"));
  line("boundary", counted(t.boundary_edges, "edge") + " in " + counted(t.boundary_loops, "loop"));
  line("components", fmt::format("{}", t.components));
  line("Euler characteristic", fmt::format("{}", t.euler_characteristic));
  return text;
}

double bytes_per_triangle(const Statistics& tree) {
  return tree.triangles == 0 ? 0.0 : static_cast<double>(tree.bytes) / static_cast<double>(tree.triangles);
}

std::string trees_text(const std::vector<Statistics>& trees) {
  std::string text = fmt::format("  {:<6}{:>10}{:>10}{:>7}{:>8}{:>11}{:>10}{:>13}{:>10}\n", "tree", "nodes",
                                 "leaves", "depth", "fill", "leaf fill", "SAH cost", "bytes/tri", "build");
  for (const Statistics& tree : trees) {
    text += fmt::format("  {:<6}{:>10}{:>10}{:>7}{:>6.0f} %{:>9.0f} %{:>10.1f}{:>13.1f}{:>7.1f} ms\n",
                        fmt::format("bvh{}", tree.width), tree.nodes, tree.leaves, tree.depth,
                        100.0 * tree.fill, 100.0 * tree.leaf_fill, tree.sah_cost, bytes_per_triangle(tree),
                        1e3 * tree.build_seconds);
  }
  return text;
}

nlohmann::json vector_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }

nlohmann::json to_json(const Info& info) {
  const Topology& t = info.topology;
  nlohmann::json trees = nlohmann::json::array();
  for (const Statistics& tree : info.trees) {
    trees.push_back({{"name", fmt::format("bvh{}", tree.width)},
                     {"width", tree.width},
                     {"nodes", tree.nodes},
                     {"leaves", tree.leaves},
                     {"depth", tree.depth},
                     {"fill", tree.fill},
                     {"leaf_fill", tree.leaf_fill},
                     {"sah_cost", tree.sah_cost},
                     {"bytes", tree.bytes},
                     {"bytes_per_triangle", bytes_per_triangle(tree)},
                     {"unseen_triangles", tree.unseen_triangles},
                     {"build_seconds", tree.build_seconds}});
  }
  const nlohmann::json none;
  return {{"plumb", PLUMB_VERSION},
          {"scene",
           {{"name", info.name},
            {"vertices", info.vertices},
            {"triangles", info.triangles},
            {"least", info.box.is_empty() ? none : vector_json(info.box.least)},
            {"greatest", info.box.is_empty() ? none : vector_json(info.box.greatest)}}},
          {"topology",
           {{"positions", t.positions},
            {"triangles", t.triangles},
            {"non_finite", t.non_finite},
            {"collapsed", t.collapsed},
            {"degenerate", t.degenerate},
            {"duplicates", t.duplicates},
            {"unused_vertices", t.unused_vertices},
            {"repeated_vertices", t.repeated_vertices},
            {"edges", t.edges},
            {"boundary_edges", t.boundary_edges},
            {"non_manifold_edges", t.non_manifold_edges},
            {"odd_edges", t.odd_edges},
            {"turned_edges", t.turned_edges},
            {"non_manifold_positions", t.non_manifold_positions},
            {"unjoined_triangles", t.unjoined_triangles},
            {"first_unjoined", t.first_unjoined},
            {"components", t.components},
            {"boundary_loops", t.boundary_loops},
            {"euler_characteristic", t.euler_characteristic},
            {"closed", t.closed()},
            {"manifold", t.manifold()},
            {"oriented", t.oriented()}}},
          {"trees", trees}};
}

ExitStatus run_info(const InfoOptions& options) {
  if (options.width != 0 && options.width != 2 && options.width != 4 && options.width != 8) {
    throw Error(fmt::format("plumb: --width {}: give 2, 4 or 8", options.width));
  }
  const Info info = look_at(options);
  print_line(options.json ? to_json(info).dump(2) : mesh_text(info) + "\n" + trees_text(info.trees));
  return kAgree;
}

}  // namespace

void add_info_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("info", "Say what a mesh and its trees are like");
  const auto options = std::make_shared<InfoOptions>();
  add_scene_option(*command, options->scene);
  command->add_option("--width", options->width, "only the tree of 2, 4 or 8 children")->type_name("N");
  command->add_option("--threads", options->threads, "threads; 0 takes all")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print it as JSON");
  command->footer(info_help());
  command->callback([options, &status] { status = run_info(*options); });
}

}  // namespace plumb::tool
