#pragma once

#include <string>
#include <string_view>

#include "io/mesh_builder.h"
#include "io/stream_job.h"
#include "plumb/io.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// Reads a whole PLY file from memory; `file` names it in messages. Reads the properties x, y, z of
/// element "vertex" and the list vertex_indices (or vertex_index) of element "face", of any types and
/// in any order; all else is passed over, and so is what follows the last element. Rows are counted
/// from 0 in messages. Throws plumb::Error.
TriangleMesh read_ply(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits = {});

/// The same of a file that is not in memory: gives its mesh in parts.
MeshReport stream_ply(const StreamJob& job);

}  // namespace plumb::detail
