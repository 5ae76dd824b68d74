#pragma once

#include <functional>
#include <string>

#include "io/cursor.h"
#include "io/mesh_builder.h"
#include "io/mesh_file.h"
#include "io/stream_job.h"
#include "plumb/io.h"

namespace plumb::detail {

/// What is to be streamed, and how.
struct FileStream {
  const FileBytes& file;  ///< not empty
  MeshFormat format = MeshFormat::Ply;
  std::string name;  ///< of the file, in messages
  MeshLimits limits;
  StreamSizes sizes;
  std::function<bool(double)> progress;
};

/// Gives the file's mesh in parts, as stream_mesh() does. Callers hold the default floating-point mode.
MeshReport stream_file(const FileStream& stream, const PartSink& sink);

}  // namespace plumb::detail
