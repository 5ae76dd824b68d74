#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "plumb/io.h"
#include "plumb/mesh.h"

namespace plumb {

/// How a mesh file is streamed.
struct StreamOptions {
  /// The id of the mesh's first triangle: where several files make one scene, how many triangles came before.
  /// All ids must be below kNone.
  std::uint32_t first_id = 0;
  /// What reading may hold at a time, parts included, whatever the file's size: bytes, at least 2^20. More of
  /// them make larger parts, and files whose triangles name vertices far from each other faster.
  std::size_t memory_bytes = std::size_t{1} << 26;
  /// Called now and then with the share of the file done, rising from 0 to 1, from the calling thread.
  /// Returning false cancels: Cancelled is thrown. When it throws, its exception comes out.
  std::function<bool(double)> progress = nullptr;
};

/// Reads a mesh file that need not fit the memory and gives its mesh in parts: the triangles in the order of
/// their ids, each part with those of its vertices that it uses, and `first_id`, the id of its first
/// triangle. The view lives as long as the call of `part`, which comes from the calling thread, under the
/// default floating-point mode; an exception that it throws comes out.
///
/// What is accepted, what is refused and with which message, coordinates, ids and the report are those of
/// load_mesh(); only a word of a text of more than 64 KiB and a PLY header of more than a quarter of the
/// memory are refused as well. A file's fault is found where it is: parts of what comes before have been
/// given by then.
///
/// Vertices of texts and of some PLY files are copied into a file without a name in the folder for temporary
/// files (TMPDIR), 12 bytes each, and so are triangles that come before vertices that they name, and all that
/// follow these. Where triangles name vertices far from each other, each part reads through all vertices.
/// Throws plumb::Error, for options out of range as well. Link plumb::io.
MeshReport stream_mesh(const std::filesystem::path& path,
                       const std::function<void(MeshView part, std::uint32_t first_id)>& part,
                       const StreamOptions& options = {});

}  // namespace plumb
