#pragma once

#include <string>
#include <string_view>

#include "io/mesh_builder.h"
#include "io/stream_job.h"
#include "plumb/io.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// Reads a whole OBJ file from memory; `file` names it in messages. Reads the vertices (v) and the
/// faces (f); texture coordinates, normals, groups, materials, points and lines are passed over, any
/// other statement is an error. A face's positive index may name a vertex that comes later in the
/// file, a negative one counts back from the last vertex before the face. Throws plumb::Error.
TriangleMesh read_obj(std::string_view text, const std::string& file, MeshReport& report,
                      const MeshLimits& limits = {});

/// The same of a file that is not in memory: gives its mesh in parts.
MeshReport stream_obj(const StreamJob& job);

}  // namespace plumb::detail
