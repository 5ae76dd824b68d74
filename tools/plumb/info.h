#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "plumb/advise.h"
#include "plumb/mesh.h"
#include "plumb/raster.h"
#include "plumb/statistics.h"
#include "plumb/topology.h"

namespace plumb::tool {

/// The box around points; without any, `least` is greater than `greatest`.
struct Box {
  glm::vec3 least, greatest;
  bool is_empty() const { return !(least.x <= greatest.x); }
};

/// Around the vertices whose coordinates are finite, used or not.
Box box_of(MeshView mesh);

/// A tree, or another structure, by its method's name.
struct NamedTree {
  std::string name;
  Statistics statistics;
};

/// What `plumb info` found out about a scene.
struct Info {
  std::string name;
  std::size_t vertices, triangles;
  Box box;
  Topology topology;
  std::vector<NamedTree> trees;  ///< in the order in which they were built
  RasterCounts raster;           ///< at the scene's camera, 1280x720
  Advice advice;                 ///< what to take for ten million rays
};

/// Memory held, by the mesh's triangles; 0 where it has none.
double bytes_per_triangle(const Statistics& tree);

/// For people: several lines, without the last line's end.
std::string to_text(const Info& info);

/// As a JSON object, as docs/tool.md describes it.
std::string to_json(const Info& info);

}  // namespace plumb::tool
