#pragma once

#include <string>
#include <string_view>

#include "io/mesh_builder.h"
#include "io/stream_job.h"
#include "plumb/io.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// Reads a whole STL file, text or binary, from memory; `file` names it in messages. Each triangle has
/// its own three vertices. Normals must be numbers; they, the solids' names, a binary file's header and
/// attributes and what follows its last triangle are passed over. Throws plumb::Error.
TriangleMesh read_stl(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits = {});

/// The same of a file that is not in memory: gives its mesh in parts.
MeshReport stream_stl(const StreamJob& job);

}  // namespace plumb::detail
