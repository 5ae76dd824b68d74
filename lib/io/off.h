#pragma once

#include <string>
#include <string_view>

#include "io/mesh_builder.h"
#include "io/stream_job.h"
#include "plumb/io.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// Reads a whole OFF file from memory; `file` names it in messages. Normals, colours and texture
/// coordinates of vertices (NOFF, COFF, STOFF) and the colours of faces must be numbers and are passed
/// over, and so is what follows the last face. Rows are counted from 0 in messages. Throws plumb::Error.
TriangleMesh read_off(std::string_view text, const std::string& file, MeshReport& report,
                      const MeshLimits& limits = {});

/// The same of a file that is not in memory: gives its mesh in parts.
MeshReport stream_off(const StreamJob& job);

}  // namespace plumb::detail
