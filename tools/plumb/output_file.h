#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace plumb::tool {

/// Makes the folder, with those above it. Throws plumb::Error that names it.
void make_folder(const std::filesystem::path& folder);

/// Writes a whole file: into one beside it that takes its name when all is on the disk, so that no
/// half-written file is ever seen under the name. What is there and is no regular file (a device, a
/// pipe) is written to as it is. Throws plumb::Error that names the file.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Prints a line on standard output. Throws plumb::Error when that cannot be written.
void print_line(std::string_view line);

}  // namespace plumb::tool
