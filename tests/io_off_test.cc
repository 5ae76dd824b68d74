#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io_util.h"

using namespace plumb;
using namespace plumb::test;

namespace {

// Four vertices and faces whose lines are given.
std::string off(int faces, const std::string& lines) {
  return "OFF\n4 " + std::to_string(faces) + " 0\n0 0 0\n1 0 0\n0 1 0\n1 1 -3\n" + lines;
}

const std::string kFace = "3 0 1 2\n";

Loaded read(const std::string& text) { return read_exact("a.off", text); }

using Triangles = std::vector<glm::uvec3>;
using Points = std::vector<glm::vec3>;

}  // namespace

TEST_SUITE("off") {
  TEST_CASE("vertices and faces keep the order of the file, and polygons become fans") {
    const Loaded loaded = read(off(4, "3 2 1 0\n5 3 2 1 0 1\n3 1 1 1\n3 2 1 0\n"));
    CHECK(loaded.mesh.positions == Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -3}});
    CHECK(loaded.mesh.triangles ==
          Triangles{{2, 1, 0}, {3, 2, 1}, {3, 1, 0}, {3, 0, 1}, {1, 1, 1}, {2, 1, 0}});
    CHECK(loaded.report.vertices == 4);
    CHECK(loaded.report.faces == 4);
    CHECK(loaded.report.triangles == 6);
  }

  TEST_CASE("a face may have a colour: an index, 3 or 4 numbers") {
    const Loaded loaded =
        read(off(5, "3 0 1 2\n3 0 1 2 7\n3 0 1 2 255 0 0\n3 0 1 2 0.5 .5 0 1\n3 0 1 2 -1\n"));
    CHECK(loaded.mesh.triangles == Triangles(5, {0, 1, 2}));
  }

  TEST_CASE("the count of edges may be missing or wrong, the counts may follow the keyword") {
    for (const std::string start :
         {"OFF\n3 1\n", "OFF\n3 1 0\n", "OFF\n3 1 -77\n", "OFF 3 1 3\n", "OFF 3 1\n",
          "OFF\n\n# c\n\t3  1 99 # edges\n", "# c\n\nOFF # c\n3 1 0\n"}) {
      CAPTURE(start);
      CHECK(read(start + "0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n").mesh.triangles == Triangles{{2, 1, 0}});
    }
  }

  TEST_CASE("comments and blank lines may be anywhere") {
    const Loaded loaded = read(
        "\xef\xbb\xbf#OFF\n \nOFF#\n#\n2 1# 1 2 3\n\n# 9 9 9\n1 2 3#4\n  # \n\t4 5 6 # 7\n\n#\n3 0 1 0#9\n# "
        "end");
    CHECK(loaded.mesh.positions == Points{{1, 2, 3}, {4, 5, 6}});
    CHECK(loaded.mesh.triangles == Triangles{{0, 1, 0}});
  }

  TEST_CASE("normals, colours and texture coordinates of vertices are passed over") {
    const std::vector<std::pair<std::string, std::string>> cases = {{"NOFF", " 0 0 1"},
                                                                    {"COFF", " 255 0 0"},
                                                                    {"COFF", " 255 0 0 128"},
                                                                    {"STOFF", " 0.5 0.5"},
                                                                    {"CNOFF", " 0 0 1 255 0 0 1"},
                                                                    {"STNOFF", " 0 0 1 .5 .5"},
                                                                    {"STCNOFF", " 0 0 1 1 1 1 .5 .5"},
                                                                    {"STCNOFF", " 0 0 1 1 1 1 1 .5 .5"}};
    for (const auto& entry : cases) {
      CAPTURE(entry.first);
      const Loaded loaded =
          read(entry.first + "\n2 1 0\n1 2 3" + entry.second + "\n4 5 6" + entry.second + "\n3 0 1 0\n");
      CHECK(loaded.mesh.positions == Points{{1, 2, 3}, {4, 5, 6}});
      CHECK(loaded.mesh.triangles == Triangles{{0, 1, 0}});
    }
  }

  TEST_CASE("lines end with LF, CR LF or CR, the last with nothing") {
    for (const std::string end : {"\n", "\r\n", "\r", " \t\r\n\n"}) {
      const std::string text =
          "OFF" + end + "3 1 0" + end + "0 0 0" + end + "1 0 0" + end + "0 1 0" + end + "3 0 1 2";
      CHECK(read(text).mesh.triangles == Triangles{{0, 1, 2}});
      CHECK(read(text + end).mesh.triangles == Triangles{{0, 1, 2}});
    }
  }

  TEST_CASE("what follows the last face does not matter, and an empty mesh is a mesh") {
    CHECK(read(off(1, kFace + "more\n3 0 1\n")).mesh.triangles == Triangles{{0, 1, 2}});
    CHECK(read("OFF 0 0 0").report.vertices == 0);
    CHECK(read("OFF\n1 0\n1 2 3").mesh.positions == Points{{1, 2, 3}});
  }

  TEST_CASE("numbers are rounded once, nan and inf are kept and counted") {
    const Loaded loaded = read(
        "OFF\n5 3\n+1.000000059604644775390625000001 1e-40 -1e-50\nnan 0 0\n1e50 0 0\n0 -inf 0\n0 0 0\n"
        "3 0 0 4\n3 0 1 4\n3 3 2 1\n");
    CHECK(loaded.mesh.positions[0].x == 1 + 0x1p-23f);
    CHECK(loaded.mesh.positions[0].y == 1e-40f);
    CHECK(same_bits(loaded.mesh.positions[0].z, -0.0f));
    CHECK(std::isnan(loaded.mesh.positions[1].x));
    CHECK(loaded.mesh.positions[2].x == std::numeric_limits<float>::infinity());
    CHECK(loaded.report.non_finite_vertices == 3);
    CHECK(loaded.report.unseen_triangles == 2);
  }
}

TEST_SUITE("off errors") {
  TEST_CASE("a wrong header is refused with its line") {
    check_cases(
        "bad.off",
        {
            {"", "line 1: ", "begins with OFF"},
            {"\n# c\n", "line 3: ", "begins with OFF"},
            {"ply\n", "line 1: ", "begins with OFF"},
            {"3 1 0\n0 0 0\n", "line 1: ", "begins with OFF"},
            {"off\n0 0 0\n", "line 1: ", "begins with OFF"},
            {"OFF8 6 0\n", "line 1: ", "begins with OFF"},
            {"XOFF\n", "line 1: ", "found \"XOFF\""},
            {"NCOFF\n", "line 1: ", "found \"NCOFF\""},
            {"4OFF\n", "line 1: ", "\"4OFF\" has vertices in another space"},
            {"\nnOFF\n3\n", "line 2: ", "\"nOFF\" has vertices in another space"},
            {"STCN4nOFF\n", "line 1: ", "\"STCN4nOFF\" has vertices in another space"},
            {"OFF BINARY\n\1\2", "line 1: ", "binary OFF files are not read"},
            {"OFF\n", "line 2: ", "the file ends before its counts"},
            {"OFF", "line 1: ", "the file ends before its counts"},
            {"OFF\n3\n", "line 2: ", "the counts of vertices, faces and perhaps edges, found the end"},
            {"OFF\n3 x 0\n", "line 2: ", "perhaps edges, found \"x\""},
            {"OFF\n-3 1 0\n", "line 2: ", "the count -3 is negative"},
            {"OFF\n3.5 1 0\n", "line 2: ", "found \"3.5\""},
            {"OFF\n3 99999999999999999999 0\n", "line 2: ", "found \"99999999999999999999\""},
            {"OFF\n3 1 many\n", "line 2: ", "expected a count of edges, found \"many\""},
            {"OFF\n3 1 0 0\n", "line 2: ", "the line goes on after its last value: \"0\""},
            {"OFF\n4294967296 1 0\n", "line 2: ", "more than 4294967295 vertices"},
        });
  }

  TEST_CASE("counts that the file cannot hold are refused before anything is allocated") {
    check_cases(
        "bad.off",
        {
            {"OFF\n4294967295 0 0\n0 0 0\n", "line 2: ", "the count of vertices claims 4294967295 rows"},
            {"OFF\n2 0 0\n0 0 0\n1 0\n", "line 2: ", "claims 2 rows of at least 6 bytes, but only 11"},
            {"COFF\n1 0 0\n0 0 0 0 0\n", "line 2: ", "claims 1 rows of at least 12 bytes"},
            {"STNOFF\n1 0 0\n0 0 0 0 0 0 0\n", "line 2: ", "claims 1 rows of at least 16 bytes"},
            {off(900000000, kFace),
             "line 2: ", "the count of faces claims 900000000 rows of at least 8 bytes"},
            {"OFF\n0 9223372036854775807 0\n" + kFace, "line 2: ", "the count of faces claims"},
        });
    REQUIRE(error_of_reading("good.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 0") == "no error");
    CHECK(contains(error_of_reading("bad.off", "OFF\n2 2 0\n0 0 0\n1 0 0\n3 0 1 0"), "claims 2 rows"));
  }

  TEST_CASE("a wrong row is refused with its line") {
    check_cases(
        "bad.off",
        {
            {"OFF\n2 0 0\n0 0 0\n1 zero 0\n", "line 4 (vertex 1): ", "expected a number, found \"zero\""},
            {"OFF\n2 0 0\n0 0\n1 0 0 0 0\n",
             "line 3 (vertex 0): ", "expected a number, found the end of the line"},
            {"OFF\n2 0 0\n0 0 0 7\n1 0 0\n",
             "line 3 (vertex 0): ", "has 0 numbers after its coordinates, this one has 1"},
            {"OFF\n2 0 0\n0 0 0x0\n1 0 0\n", "line 3 (vertex 0): ", "found \"0x0\""},
            {"OFF\n2 0 0\n0 0 0.000000\n", "line 4 (vertex 1): ", "the file ends here"},
            {"NOFF\n1 0 0\n0 0 0 0 0 red\n", "line 3 (vertex 0): ", "expected a number, found \"red\""},
            {"NOFF\n1 0 0\n0 0 0.00000 0 1\n",
             "line 3 (vertex 0): ", "has 3 numbers after its coordinates, this one has 2"},
            {"COFF\n1 0 0\n0 0 0 1 1 1 1 1\n",
             "line 3 (vertex 0): ", "has 3 or 4 numbers after its coordinates, this one has 5"},
            {"CNOFF\n1 0 0\n0 0 0 1.000 1 1 1\n",
             "line 3 (vertex 0): ", "has 6 or 7 numbers after its coordinates, this one has 4"},
            {off(1, "3 0 1 4\n"),
             "line 7 (face 0): ", "vertex index 4 is out of range; there are 4 vertices"},
            {off(1, "3 0 1 -1\n"), "line 7 (face 0): ", "vertex index -1 is out of range"},
            {off(1, "3 0 1 2.0\n"), "line 7 (face 0): ", "expected a vertex index, found \"2.0\""},
            {off(1, "3 0 1 99999999999999999999\n"), "line 7 (face 0): ", "expected a vertex index"},
            {off(1, "4 0 1 2\n"), "line 7 (face 0): ", "expected a vertex index, found the end of the line"},
            {off(2, kFace + "# c\n\n3 0 1\n2\n"), "line 10 (face 1): ", "found the end of the line"},
            {off(1, "2 0 1      \n"), "line 7 (face 0): ", "3 corners or more, this one has 2"},
            {off(1, "-3 0 1 2\n"), "line 7 (face 0): ", "negative number of corners -3"},
            {off(1, "three 0 1 2\n"), "line 7 (face 0): ", "expected the number of a face's corners"},
            {off(1, "9223372036854775807 0 1 2\n"), "line 7 (face 0): ", "found the end of the line"},
            {off(1, "3 0 1 2 1 0\n"), "line 7 (face 0): ", "1, 3 or 4 numbers after its corners; found 2"},
            {off(1, "3 0 1 2 1 0 0 0 0\n"), "line 7 (face 0): ", "found 5"},
            {off(1, "3 0 1 2 red\n"), "line 7 (face 0): ", "expected a number, found \"red\""},
            {off(2, "3 0 1 2 0 0 0 0\n"), "line 8 (face 1): ", "the file ends here"},
            {"OFF\r\n1 0\r\nx 0 0\r\n", "line 3 (vertex 0): ", "found \"x\""},
            {"OFF\r1 0\rx 0 0\r", "line 3 (vertex 0): ", "found \"x\""},
            {std::string("OFF\n1 0\n0 0 \0\n", 14), "line 3 (vertex 0): ", "found \"\\x00\""},
        });
  }

  TEST_CASE("more triangles or vertices than there are ids are refused") {
    const std::string text = off(2, "5 0 1 2 3 0\n" + kFace);
    CHECK(contains(error_of_reading("bad.off", text, {.triangles = 3}),
                   "line 8 (face 1): more than 3 triangles"));
    CHECK(contains(error_of_reading("bad.off", text, {.vertices = 3}), "line 2: more than 3 vertices"));
    CHECK(error_of_reading("bad.off", text, {.vertices = 4, .triangles = 4}) == "no error");
  }
}
