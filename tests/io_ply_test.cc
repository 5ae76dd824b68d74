#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "io_util.h"
#include "ply_util.h"

using namespace plumb;
using namespace plumb::test;

namespace {

const std::vector<glm::uvec3> kTriangles = {{0, 1, 2}, {4, 3, 2}, {4, 2, 1}, {4, 1, 0}, {2, 2, 2}, {0, 1, 2}};

void check_mesh(const Loaded& loaded) {
  REQUIRE(loaded.mesh.positions.size() == kVertices.size());
  for (std::size_t i = 0; i < kVertices.size(); ++i) {
    const glm::dvec3 expected{kVertices[i][0], kVertices[i][1], kVertices[i][2]};
    CHECK(glm::dvec3(loaded.mesh.positions[i]) == expected);
  }
  CHECK(loaded.mesh.triangles == kTriangles);
  CHECK(loaded.report.vertices == 5);
  CHECK(loaded.report.faces == 4);
  CHECK(loaded.report.triangles == 6);
  CHECK(loaded.report.non_finite_vertices == 0);
  CHECK(loaded.report.unseen_triangles == 0);
}

std::string with_crlf(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

}  // namespace

TEST_SUITE("ply") {
  TEST_CASE("every format, coordinate type, index type and length type reads exactly") {
    const std::vector<std::string> integers = {"char", "uchar", "short", "ushort", "int",   "uint",
                                               "int8", "uint8", "int16", "uint16", "int32", "uint32"};
    std::vector<std::string> all = integers;
    all.insert(all.end(), {"float", "double", "float32", "float64"});
    for (const std::string& format : kPlyFormats) {
      for (const std::string& coordinate : all) {
        check_mesh(read_exact("a.ply", make_ply(format, kVertices, kFaces, {coordinate, "uchar", "int"})));
      }
      for (const std::string& index : integers) {
        for (const std::string& count : integers) {
          check_mesh(read_exact("a.ply", make_ply(format, kVertices, kFaces, {"float", count, index})));
        }
      }
    }
  }

  TEST_CASE("integers and doubles round once to the nearest float, ties to even") {
    for (const std::string& format : kPlyFormats) {
      const auto read = [&](const std::string& type, double x, double y, double z) {
        const std::string bytes = make_ply(format, {{x, y, z}}, {}, {type, "uchar", "int"});
        return read_exact("a.ply", bytes).mesh.positions.at(0);
      };
      CHECK(read("int", 16777217, 16777219, -2147483647) ==
            glm::vec3(16777216.0f, 16777220.0f, -2147483648.0f));
      CHECK(read("uint", 4294967295.0, 4294967040.0, 2147483649.0) ==
            glm::vec3(4294967296.0f, 4294967040.0f, 2147483648.0f));
      CHECK(read("double", 0.1, 1 + 0x1p-24, 1 + 3 * 0x1p-24) == glm::vec3(0.1f, 1.0f, 1 + 0x1p-22f));
      const glm::vec3 extreme = read("double", 1e300, -1e-300, 0x1p-149);
      CHECK(extreme.x == std::numeric_limits<float>::infinity());
      CHECK(same_bits(extreme.y, -0.0f));
      CHECK(extreme.z == std::numeric_limits<float>::denorm_min());
    }
    // A text is rounded once, whatever the property's type.
    const std::string text = ascii(
        "element vertex 1\nproperty double x\nproperty double y\nproperty float z\nend_header\n"
        "1.000000059604644775390625000001 1e50 1e-50\n");
    CHECK(read_exact("a.ply", text).mesh.positions.at(0) ==
          glm::vec3(1 + 0x1p-23f, std::numeric_limits<float>::infinity(), 0.0f));
  }

  TEST_CASE("what the mesh does not need is passed over") {
    for (const std::string& format : kPlyFormats) {
      CAPTURE(format);
      std::string out =
          "ply\nformat " + format +
          " 1.0\ncomment element vertex 9\nobj_info property float q\n"
          "element camera 1\nproperty double fov\nelement nothing 1000000000000\n"
          "element vertex 3\nproperty list uchar double weights\nproperty uchar red\nproperty float z\n"
          "comment between\nproperty short y\nproperty double x\nproperty float x2\n"
          "element edge 2\nproperty int vertex1\nproperty list int short tags\n"
          "element face 2\nproperty uchar flags\nproperty list uchar float texcoord\n"
          "property list ushort uint vertex_index\nproperty char last\n"
          "element other 1\nproperty list uint uchar bytes\nend_header\n";
      const auto row = [&](const std::vector<std::pair<const char*, double>>& values) {
        for (const auto& [type, value] : values) put(out, format, type, value);
        end_row(out, format);
      };
      row({{"double", 45.5}});
      row({{"uchar", 2},
           {"double", 0.5},
           {"double", 0.25},
           {"uchar", 255},
           {"float", 3},
           {"short", -2},
           {"double", 1},
           {"float", 9}});
      row({{"uchar", 0}, {"uchar", 255}, {"float", 6}, {"short", -5}, {"double", 4}, {"float", 9}});
      row({{"uchar", 1},
           {"double", 0.5},
           {"uchar", 255},
           {"float", 9},
           {"short", -8},
           {"double", 7},
           {"float", 9}});
      row({{"int", 7}, {"int", 3}, {"short", -1}, {"short", -2}, {"short", -3}});
      row({{"int", 8}, {"int", 0}});
      row({{"uchar", 200},
           {"uchar", 1},
           {"float", 0.5},
           {"ushort", 3},
           {"uint", 2},
           {"uint", 1},
           {"uint", 0},
           {"char", -1}});
      row({{"uchar", 201},
           {"uchar", 0},
           {"ushort", 4},
           {"uint", 0},
           {"uint", 1},
           {"uint", 2},
           {"uint", 0},
           {"char", -1}});
      row({{"uint", 2}, {"uchar", 65}, {"uchar", 66}});
      const Loaded loaded = read_exact("a.ply", out);
      CHECK(loaded.mesh.positions == std::vector<glm::vec3>{{1, -2, 3}, {4, -5, 6}, {7, -8, 9}});
      CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{2, 1, 0}, {0, 1, 2}, {0, 2, 0}});
      CHECK(loaded.report.faces == 2);
    }
  }

  TEST_CASE("faces may come before vertices") {
    const std::string bytes = ascii(kFaceHeader + "element vertex 3\n" + kVertexHeader +
                                    "end_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n");
    const Loaded loaded = read_exact("a.ply", bytes);
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{2, 1, 0}});
    CHECK(loaded.mesh.positions.at(1) == glm::vec3(1, 0, 0));
  }

  TEST_CASE("lines may end with CR LF, in a text and in the header of a binary file") {
    check_mesh(read_exact("a.ply", with_crlf(make_ply("ascii", kVertices, kFaces))));
    for (const std::string& format : kPlyFormats) {
      const std::string bytes = make_ply(format, kVertices, kFaces);
      const std::size_t body = bytes.find("end_header\n") + 11;
      check_mesh(read_exact("a.ply", with_crlf(bytes.substr(0, body)) + bytes.substr(body)));
    }
  }

  TEST_CASE("what follows the last element, and a missing last line end, do not matter") {
    for (const std::string& format : kPlyFormats) {
      check_mesh(read_exact("a.ply", make_ply(format, kVertices, kFaces) + "\nmore\n"));
    }
    std::string text = make_ply("ascii", kVertices, kFaces);
    text.pop_back();
    check_mesh(read_exact("a.ply", text));
    check_mesh(read_exact("a.ply", text + "  \t "));
  }

  TEST_CASE("blank lines and blanks of any number do not matter") {
    const std::string bytes =
        ascii("element   vertex\t1 \n" + kVertexHeader + "\nend_header \n\n  \n  1\t 2   3 \n");
    CHECK(read_exact("a.ply", bytes).mesh.positions == std::vector<glm::vec3>{{1, 2, 3}});
  }

  TEST_CASE("an empty mesh is a mesh") {
    for (const std::string& format : kPlyFormats) {
      const Loaded loaded = read_exact("a.ply", make_ply(format, {}, {}));
      CHECK(loaded.mesh.positions.empty());
      CHECK(loaded.mesh.triangles.empty());
      const std::string start = "ply\nformat " + format + " 1.0\n";
      CHECK(read_exact("a.ply", start + "end_header\n").mesh.positions.empty());
      CHECK(read_exact("a.ply", start + "element vertex 0\nelement face 0\nend_header\n").report.faces == 0);
    }
    CHECK(read_exact("a.ply", ascii("element vertex 1\n" + kVertexHeader + "end_header\n1 2 3\n"))
              .report.vertices == 1);
  }

  TEST_CASE("vertices that are not finite are kept and counted, with the triangles they hide") {
    const double inf = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const std::string& format : kPlyFormats) {
      const std::vector<std::array<double, 3>> vertices = {
          {0, 0, 0}, {nan, 1, 2}, {1, -inf, 2}, {1, 2, inf}, {3, 3, 3}};
      const std::vector<std::vector<std::uint32_t>> faces = {
          {0, 0, 4}, {0, 1, 4}, {2, 3, 1}, {4, 4, 4}, {0, 4, 3}};
      const Loaded loaded = read_exact("a.ply", make_ply(format, vertices, faces));
      CHECK(std::isnan(loaded.mesh.positions[1].x));
      CHECK(loaded.mesh.positions[1].z == 2.0f);
      CHECK(loaded.mesh.positions[2].y == -std::numeric_limits<float>::infinity());
      CHECK(loaded.mesh.positions[4] == glm::vec3(3, 3, 3));
      CHECK(loaded.report.non_finite_vertices == 3);
      CHECK(loaded.report.triangles == 5);
      CHECK(loaded.report.unseen_triangles == 3);
    }
  }
}
