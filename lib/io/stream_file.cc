#include "io/stream_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"

namespace plumb::detail {
namespace {

MeshReport read(MeshFormat format, const StreamJob& job) {
  switch (format) {
    case MeshFormat::Ply:
      return stream_ply(job);
    case MeshFormat::Obj:
      return stream_obj(job);
    case MeshFormat::Stl:
      return stream_stl(job);
    default:
      return stream_off(job);
  }
}

}  // namespace

MeshReport stream_file(const FileStream& stream, const PartSink& sink) {
  StreamProgress progress(stream.progress, stream.file.size);
  // No file has more triangles than bytes: what a small one cannot need is not asked for.
  StreamSizes sizes = stream.sizes;
  sizes.part_triangles =
      static_cast<std::size_t>(std::min<std::uint64_t>(sizes.part_triangles, stream.file.size));
  const Window window{stream.file, sizes.window_bytes, sizes.longest_word,
                      [&](std::uint64_t offset) { progress.read_to(offset); }};
  const StreamJob job{window, stream.name, stream.limits, sizes, progress, sink};
  const MeshReport report = read(stream.format, job);
  progress.end();
  return report;
}

}  // namespace plumb::detail
