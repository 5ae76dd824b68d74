#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_builder.h"

namespace plumb::detail {

enum class PlyFormat { Ascii, BinaryLittleEndian, BinaryBigEndian };
enum class PlyType : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

/// What the mesh takes from a property.
enum class PlyUse : std::uint8_t { Nothing, X, Y, Z, Corners };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Int8;  // of the value, or of each entry of a list
  bool is_list = false;
  PlyType count_type = PlyType::Int8;  // of a list's length
  PlyUse use = PlyUse::Nothing;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t line = 0;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;  // in the order of the file
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::size_t bytes = 0;  // of the header: the body begins there
  std::size_t lines = 0;
};

bool is_real(PlyType type);
std::size_t size_of(PlyType type);
const char* name_of(PlyType type);

/// Reads the header of a PLY file and checks that the file is long enough for the counts in it, so
/// that nothing is allocated that is not there. Of the file's bytes the first may be enough; nothing when the
/// header goes on behind them. Throws plumb::Error with the line at fault.
std::optional<PlyHeader> read_ply_header(std::string_view first_bytes, std::uint64_t file_bytes,
                                         const std::string& file, const MeshLimits& limits);

}  // namespace plumb::detail
