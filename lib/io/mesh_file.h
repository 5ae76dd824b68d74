#pragma once

#include <cstdint>
#include <filesystem>

namespace plumb::detail {

enum class MeshFormat { Ply, Obj, Stl, Off };

/// The format that the file's extension names. Throws plumb::Error that lists the known ones.
MeshFormat mesh_format(const std::filesystem::path& path);

/// Throws plumb::Error that names what is there if it is no regular file.
void check_regular_file(const std::filesystem::path& path);

/// Bytes of a file. Throws plumb::Error when it is empty.
std::uint64_t file_bytes(const std::filesystem::path& path);

}  // namespace plumb::detail
