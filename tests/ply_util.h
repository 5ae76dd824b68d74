#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

// Making PLY files for the tests.

namespace plumb::test {

inline const std::string kVertexHeader = "property float x\nproperty float y\nproperty float z\n";
inline const std::string kFaceHeader = "element face 1\nproperty list uchar int vertex_indices\n";

/// A text PLY file from what follows its line "format".
inline std::string ascii(const std::string& rest) { return "ply\nformat ascii 1.0\n" + rest; }

/// A mesh of five vertices, each coordinate a value of every type, and of four faces.
inline const std::vector<std::array<double, 3>> kVertices = {
    {0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 127}, {0, 0, 0}};
inline const std::vector<std::vector<std::uint32_t>> kFaces = {
    {0, 1, 2}, {4, 3, 2, 1, 0}, {2, 2, 2}, {0, 1, 2}};

/// The three formats of PLY files.
inline const std::vector<std::string> kPlyFormats = {"ascii", "binary_little_endian", "binary_big_endian"};

template <typename T>
void put_binary(std::string& out, T value, bool big_endian) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

/// Appends one value of a PLY body.
inline void put(std::string& out, const std::string& format, const std::string& type, double value) {
  const bool big = format == "binary_big_endian";
  if (format == "ascii") {
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), "%.30g ", value);
    out += text.data();
  } else if (type == "char" || type == "int8") {
    put_binary(out, static_cast<std::int8_t>(value), big);
  } else if (type == "uchar" || type == "uint8") {
    put_binary(out, static_cast<std::uint8_t>(value), big);
  } else if (type == "short" || type == "int16") {
    put_binary(out, static_cast<std::int16_t>(value), big);
  } else if (type == "ushort" || type == "uint16") {
    put_binary(out, static_cast<std::uint16_t>(value), big);
  } else if (type == "int" || type == "int32") {
    put_binary(out, static_cast<std::int32_t>(value), big);
  } else if (type == "uint" || type == "uint32") {
    put_binary(out, static_cast<std::uint32_t>(value), big);
  } else if (type == "float" || type == "float32") {
    put_binary(out, static_cast<float>(value), big);
  } else if (type == "double" || type == "float64") {
    put_binary(out, value, big);
  } else {
    throw std::invalid_argument(type);
  }
}

/// Ends a row of a PLY body.
inline void end_row(std::string& out, const std::string& format) {
  if (format == "ascii") out.back() = '\n';
}

/// The types in a PLY file.
struct PlyTypes {
  std::string coordinate = "float";
  std::string count = "uchar";
  std::string index = "int";
};

/// A PLY file of the given vertices and faces.
inline std::string make_ply(const std::string& format, const std::vector<std::array<double, 3>>& vertices,
                            const std::vector<std::vector<std::uint32_t>>& faces,
                            const PlyTypes& types = {}) {
  std::string out =
      "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) out += "property " + types.coordinate + " " + axis + "\n";
  out += "element face " + std::to_string(faces.size()) + "\n";
  out += "property list " + types.count + " " + types.index + " vertex_indices\nend_header\n";
  for (const auto& vertex : vertices) {
    for (const double c : vertex) put(out, format, types.coordinate, c);
    end_row(out, format);
  }
  for (const auto& face : faces) {
    put(out, format, types.count, static_cast<double>(face.size()));
    for (const std::uint32_t v : face) put(out, format, types.index, v);
    end_row(out, format);
  }
  return out;
}

}  // namespace plumb::test
