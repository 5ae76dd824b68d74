#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "io_util.h"
#include "plumb/mesh.h"
#include "ply_util.h"

// Making files of meshes for the tests.

namespace plumb::test {

/// Appends a number, in the fewest digits that read back as itself, and a character after it.
template <typename T>
void put_text(std::string& out, T value, char after) {
  std::array<char, 64> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(text.data(), result.ptr);
  out += after;
}

template <typename Vector>
void put_row(std::string& out, const Vector& v) {
  put_text(out, v.x, ' ');
  put_text(out, v.y, ' ');
  put_text(out, v.z, '\n');
}

inline std::string make_off(const TriangleMesh& mesh) {
  std::string out = "OFF\n";
  put_text(out, mesh.positions.size(), ' ');
  put_text(out, mesh.triangles.size(), ' ');
  out += "0\n";
  for (const glm::vec3& p : mesh.positions) put_row(out, p);
  for (const glm::uvec3& t : mesh.triangles) {
    out += "3 ";
    put_row(out, t);
  }
  return out;
}

inline std::string make_stl_text(const TriangleMesh& mesh) {
  std::string out = "solid mesh\n";
  for (const glm::uvec3& t : mesh.triangles) {
    out += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t v : {t.x, t.y, t.z}) {
      out += "  vertex ";
      put_row(out, mesh.positions[v]);
    }
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid mesh\n";
}

/// A PLY file of the mesh.
inline std::string make_ply_of(const TriangleMesh& mesh, const std::string& format,
                               bool faces_first = false) {
  const std::string vertex_header =
      "element vertex " + std::to_string(mesh.positions.size()) + "\n" + kVertexHeader;
  const std::string face_header =
      "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n";
  std::string vertices, faces;
  for (const glm::vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) put(vertices, format, "float", p[k]);
    end_row(vertices, format);
  }
  for (const glm::uvec3& t : mesh.triangles) {
    put(faces, format, "uchar", 3);
    for (int k = 0; k < 3; ++k) put(faces, format, "int", t[k]);
    end_row(faces, format);
  }
  std::string begin = "ply\nformat ";
  begin.append(format).append(" 1.0\n");
  return faces_first ? begin + face_header + vertex_header + "end_header\n" + faces + vertices
                     : begin + vertex_header + face_header + "end_header\n" + vertices + faces;
}

/// Where an OBJ file has its vertices.
enum class ObjOrder { VerticesFirst, FacesFirst, Mixed };

inline std::string make_obj(const TriangleMesh& mesh, ObjOrder order = ObjOrder::VerticesFirst) {
  std::vector<std::string> rows;
  for (const glm::vec3& p : mesh.positions) {
    rows.emplace_back("v ");
    put_row(rows.back(), p);
  }
  for (const glm::uvec3& t : mesh.triangles) {
    rows.emplace_back("f ");
    put_row(rows.back(), t + 1u);
  }
  std::string out;
  if (order == ObjOrder::FacesFirst)
    std::rotate(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(mesh.positions.size()), rows.end());
  if (order == ObjOrder::Mixed) {  // vertices keep their order, and so do faces
    const std::size_t vertices = mesh.positions.size();
    std::vector<std::string> mixed;
    std::mt19937_64 random(7);
    for (std::size_t v = 0, f = vertices; v < vertices || f < rows.size();) {
      const bool vertex = v < vertices && (f == rows.size() || random() % 3 == 0);
      mixed.push_back(rows[vertex ? v++ : f++]);
    }
    rows = mixed;
  }
  for (const std::string& row : rows) out += row;
  return out;
}

/// The header is filled up to 80 bytes.
inline std::string make_stl_binary(const TriangleMesh& mesh, std::string header = "made by a test",
                                   char filler = '\0') {
  header.resize(80, filler);
  put_binary(header, static_cast<std::uint32_t>(mesh.triangles.size()), false);
  for (const glm::uvec3& t : mesh.triangles) {
    for (const float n : {0.0f, 0.0f, 1.0f}) put_binary(header, n, false);
    for (const std::uint32_t v : {t.x, t.y, t.z}) {
      for (int axis = 0; axis < 3; ++axis) put_binary(header, mesh.positions[v][axis], false);
    }
    put_binary(header, std::uint16_t{0xabcd}, false);
  }
  return header;
}

/// The mesh as STL can say it: each triangle has its own vertices.
inline TriangleMesh separate_corners(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const std::uint32_t v : {t.x, t.y, t.z}) result.positions.push_back(mesh.positions[v]);
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

/// Whether the meshes are equal bit for bit, but that any NaN equals any other.
inline bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same = [](float x, float y) { return same_bits(x, y) || (std::isnan(x) && std::isnan(y)); };
  return a.triangles == b.triangles &&
         std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(),
                    [&](const glm::vec3& p, const glm::vec3& q) {
                      return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z);
                    });
}

}  // namespace plumb::test
