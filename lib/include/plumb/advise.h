#pragma once

#include <string>

#include "plumb/mesh.h"
#include "plumb/structures.h"

namespace plumb {

/// What to make a scene ready with, and why.
struct Advice {
  StructureSettings settings;  ///< for build_structure(); threads, first_id and progress are as they come
  std::string reason;          ///< a sentence
};

/// Which structure and settings to take for a mesh that will be asked about so many rays, above 0, before it
/// changes: from statistics of the triangles alone, in time proportional to them. docs/structures.md shows
/// the measurements that the rules come from, how often they were right, and what it cost where they were
/// wrong. Any structure gives the same answers. Throws plumb::Error for a vertex index out of range, and for
/// rays that are none.
Advice advise(MeshView mesh, double rays = 1e7);

}  // namespace plumb
