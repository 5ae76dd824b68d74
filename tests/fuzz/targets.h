#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// What the fuzzers look for in any bytes. Each function says in a sentence what is wrong, or nothing.

namespace plumb::fuzz {

/// Reads the bytes as a mesh file of that extension (".ply", ".obj", ".stl", ".off"). Wrong is a mesh with an
/// index out of range, a report that is not the mesh's, an exception that is not a plumb::Error which
/// begins with the file's name, and anything that streaming the file does differently. `loaded`, if not null,
/// becomes whether there is a mesh.
std::string fault_of_reader(std::string_view extension, std::string_view bytes, bool* loaded = nullptr);

/// Makes a small scene, rays and maybe a camera of the bytes. Wrong is an answer of any method on any
/// instruction set that is not the oracle's; then the text ends with a test to paste. Needs the default
/// floating-point mode.
std::string fault_of_methods(std::span<const std::uint8_t> bytes);

}  // namespace plumb::fuzz
