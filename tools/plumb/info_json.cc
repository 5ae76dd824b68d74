#include <nlohmann/json.hpp>

#include "info.h"
#include "plumb/version.h"

namespace plumb::tool {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }

Json scene_json(const Info& info) {
  Json json = {{"name", info.name}, {"vertices", info.vertices}, {"triangles", info.triangles}};
  json["least"] = info.box.is_empty() ? Json() : vector_json(info.box.least);
  json["greatest"] = info.box.is_empty() ? Json() : vector_json(info.box.greatest);
  return json;
}

Json topology_json(const Topology& t) {
  return {{"non_finite", t.non_finite},
          {"collapsed", t.collapsed},
          {"degenerate", t.degenerate},
          {"duplicates", t.duplicates},
          {"unused_vertices", t.unused_vertices},
          {"repeated_vertices", t.repeated_vertices},
          {"triangles", t.triangles},
          {"positions", t.positions},
          {"edges", t.edges},
          {"boundary_edges", t.boundary_edges},
          {"odd_edges", t.odd_edges},
          {"non_manifold_edges", t.non_manifold_edges},
          {"turned_edges", t.turned_edges},
          {"non_manifold_positions", t.non_manifold_positions},
          {"unjoined_triangles", t.unjoined_triangles},
          {"first_unjoined", t.first_unjoined},
          {"components", t.components},
          {"boundary_loops", t.boundary_loops},
          {"euler_characteristic", t.euler_characteristic},
          {"closed", t.closed()},
          {"manifold", t.manifold()},
          {"oriented", t.oriented()}};
}

Json tree_json(const NamedTree& named) {
  const Statistics& tree = named.statistics;
  return {{"name", named.name},
          {"width", tree.width},
          {"nodes", tree.nodes},
          {"leaves", tree.leaves},
          {"references", tree.references},
          {"depth", tree.depth},
          {"fill", tree.fill},
          {"leaf_fill", tree.leaf_fill},
          {"sah_cost", tree.sah_cost},
          {"bytes", tree.bytes},
          {"bytes_per_triangle", bytes_per_triangle(tree)},
          {"unseen_triangles", tree.unseen_triangles},
          {"build_seconds", tree.build_seconds}};
}

}  // namespace

std::string to_json(const Info& info) {
  Json trees = Json::array();
  for (const NamedTree& tree : info.trees) trees.push_back(tree_json(tree));
  const Json json = {{"plumb", PLUMB_VERSION},
                     {"scene", scene_json(info)},
                     {"topology", topology_json(info.topology)},
                     {"trees", trees},
                     {"raster",
                      {{"tiles", info.raster.tiles},
                       {"tiles_hidden", info.raster.tiles_hidden},
                       {"block_tests", info.raster.block_tests},
                       {"blocks", info.raster.blocks},
                       {"blocks_full", info.raster.blocks_full},
                       {"pixels_decided", info.raster.pixels_decided}}},
                     {"advice",
                      {{"structure", structure_kind_name(info.advice.settings.kind)},
                       {"quality", info.advice.settings.quality == Quality::Fast ? "fast" : "balanced"},
                       {"reason", info.advice.reason}}}};
  // A file's name may hold bytes that are no text.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace plumb::tool
