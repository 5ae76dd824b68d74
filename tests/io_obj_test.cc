#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "io_util.h"

using namespace plumb;
using namespace plumb::test;

namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Loaded read(const std::string& text) { return read_exact("a.obj", text); }

std::vector<glm::uvec3> triangles_of(const std::string& text) { return read(text).mesh.triangles; }

using Triangles = std::vector<glm::uvec3>;

}  // namespace

TEST_SUITE("obj") {
  TEST_CASE("vertices and faces keep the order of the file, and what is not a polygon is passed over") {
    const Loaded loaded = read(
        "# made by hand\nmtllib a.mtl\no thing\ng\nv 1 2 3\nvt 0.5 0.5\nvn 0 0 1\nvp 1 2\nv -1.5 2.5e1 "
        "+3.25\ns off\n"
        "usemtl red\nv .5 5. 0\ng a b c\nf 1 2 3\nl 1 2\np 1\nf 3 2 1\nf 1 1 1\nf 1 2 3\nlod 3\nbevel on\ns "
        "1\n");
    CHECK(loaded.mesh.positions == std::vector<glm::vec3>{{1, 2, 3}, {-1.5, 25, 3.25}, {0.5, 5, 0}});
    CHECK(loaded.mesh.triangles == Triangles{{0, 1, 2}, {2, 1, 0}, {0, 0, 0}, {0, 1, 2}});
    CHECK(loaded.report.vertices == 3);
    CHECK(loaded.report.faces == 4);
    CHECK(loaded.report.triangles == 4);
  }

  TEST_CASE("a corner is v, v/vt, v//vn or v/vt/vn") {
    CHECK(triangles_of(kThree + "f 1 2/7 3//8\nf 1/1/1 2/-1/-2 3/7/8\n") == Triangles{{0, 1, 2}, {0, 1, 2}});
  }

  TEST_CASE("polygons become fans") {
    const Loaded loaded = read("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 5 4 3 2 1\nf 1 2 3 4\n");
    CHECK(loaded.mesh.triangles == Triangles{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}, {0, 1, 2}, {0, 2, 3}});
    CHECK(loaded.report.faces == 2);
  }

  TEST_CASE("negative indices count back from the last vertex before the face") {
    CHECK(triangles_of(kThree + "f -3 -2 -1\nv 1 1 1\nf -1 -2/-1 -3//-1\nf 1 -1 2\n") ==
          Triangles{{0, 1, 2}, {3, 2, 1}, {0, 3, 1}});
  }

  TEST_CASE("positive indices may refer forward") {
    CHECK(triangles_of("f 1 2 3\n" + kThree) == Triangles{{0, 1, 2}});
  }

  TEST_CASE("a weight, a colour or both may follow the coordinates") {
    CHECK(read("v 1 2 3 0.5\nv 1 2 3 1 0 0\nv 1 2 3 1 1 0 0\n").mesh.positions ==
          std::vector<glm::vec3>(3, {1, 2, 3}));
  }

  TEST_CASE("a backslash continues a line") {
    CHECK(triangles_of("v 0 \\\n0 0\nv 1 0 0\\\r\n\nv 0 1\\\n 0\nf 1 2\\\n3 \\\n  1\\\n\nf 3 2 1\n") ==
          Triangles{{0, 1, 2}, {0, 2, 0}, {2, 1, 0}});
    CHECK(read("g a \\\nv 1 2 3\nv 4 5 6\n").mesh.positions == std::vector<glm::vec3>{{4, 5, 6}});
  }

  TEST_CASE("a comment ends with its line, whatever its last character") {
    CHECK(read("# C:\\dir\\\nv 1 2 3 # there \\\n\tv 4 5 6#here\n").mesh.positions ==
          std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}});
  }

  TEST_CASE("lines end with LF, CR LF or CR, the last with nothing") {
    const Triangles expected = {{0, 1, 2}};
    for (const std::string end : {"\n", "\r\n", "\r", "\n\r\n", " \t\n"}) {
      const std::string text = "# c" + end + "v 0 0 0" + end + "v 1 0 0" + end + "v 0 1 0" + end + "f 1 2 3";
      CHECK(triangles_of(text) == expected);
      CHECK(triangles_of(text + end) == expected);
    }
  }

  TEST_CASE("a byte order mark and a text without a mesh do no harm") {
    CHECK(read("\xef\xbb\xbf# c\nv 1 2 3\n").report.vertices == 1);
    CHECK(read("# nothing\n").report.vertices == 0);
    CHECK(read("\n\n").report.triangles == 0);
  }

  TEST_CASE("numbers are rounded once, nan and inf are kept and counted") {
    const Loaded loaded = read(
        "v 1.000000059604644775390625000001 1e-40 -1e-50\nv nan 0 0\nv 1e50 0 0\nv 0 -inf 0\n"
        "v 0 0 0\nf 1 1 5\nf 1 2 5\nf 4 3 2\n");
    CHECK(loaded.mesh.positions[0].x == 1 + 0x1p-23f);
    CHECK(loaded.mesh.positions[0].y == 1e-40f);
    CHECK(same_bits(loaded.mesh.positions[0].z, -0.0f));
    CHECK(std::isnan(loaded.mesh.positions[1].x));
    CHECK(loaded.mesh.positions[2].x == std::numeric_limits<float>::infinity());
    CHECK(loaded.report.non_finite_vertices == 3);
    CHECK(loaded.report.unseen_triangles == 2);
  }
}

TEST_SUITE("obj errors") {
  TEST_CASE("what is wrong is refused with its line") {
    check_cases("bad.obj",
                {
                    {"v 1 2\n", "line 1: ", "found 2 numbers"},
                    {"v\n", "line 1: ", "found 0 numbers"},
                    {"v 1 2 3 4 5\n", "line 1: ", "found 5 numbers"},
                    {"v 1 2 3 4 5 6 7 8 9\n", "line 1: ", "found 9 numbers"},
                    {kThree + "v 1 2 z\n", "line 4: ", "expected a number, found \"z\""},
                    {kThree + "v 1 2 3z\n", "line 4: ", "expected a number, found \"3z\""},
                    {kThree + "v 1 2 3 red\n", "line 4: ", "expected a number, found \"red\""},
                    {kThree + "v 1,2 3 4\n", "line 4: ", "expected a number, found \"1,2\""},
                    {kThree + "v 1 \\\n 2 \\\n x\n", "line 6: ", "expected a number, found \"x\""},
                    {kThree + "v 1 \\ \n2 3\n", "line 4: ", "expected a number, found \"\\\""},
                    {kThree + "f 1 2\n", "line 4: ", "3 corners or more, this one has 2"},
                    {kThree + "f 1 2\\\n\n", "line 4: ", "3 corners or more, this one has 2"},
                    {kThree + "f\n", "line 4: ", "3 corners or more, this one has 0"},
                    {kThree + "f 0 1 2\n", "line 4: ", "vertex index 0"},
                    {kThree + "f 1 2 -4\n",
                     "line 4: ", "vertex index -4 is out of range; 3 vertices come before the face"},
                    {"f 1 2 -1\n" + kThree, "line 1: ", "vertex index -1 is out of range"},
                    {kThree + "f 1 2 4\n", "line 4: ", "refers to vertex 4, but the file has only 3"},
                    {"f 1 2 4\nf 3 2 9\nf 9 1 5\n" + kThree + "v 1 1 1\n",
                     "line 2: ", "refers to vertex 9, but the file has only 4"},
                    {kThree + "f 1 2 4294967296\n", "line 4: ", "vertex index 4294967296 is out of range"},
                    {kThree + "f 1 2 99999999999999999999\n", "line 4: ", "expected a corner"},
                    {kThree + "f 1 2 3.5\n",
                     "line 4: ", "expected a corner v, v/vt, v//vn or v/vt/vn of integers, found \"3.5\""},
                    {kThree + "f 1 2 +3\n", "line 4: ", "found \"+3\""},
                    {kThree + "f 1 2 3/\n", "line 4: ", "found \"3/\""},
                    {kThree + "f 1 2 3//\n", "line 4: ", "found \"3//\""},
                    {kThree + "f 1 2 3/1/\n", "line 4: ", "found \"3/1/\""},
                    {kThree + "f 1 2 3/x/1\n", "line 4: ", "found \"3/x/1\""},
                    {kThree + "f 1 2 3/1/1/1\n", "line 4: ", "found \"3/1/1/1\""},
                    {kThree + "f 1 2 /1\n", "line 4: ", "found \"/1\""},
                    {kThree + "f 1 2 three\n", "line 4: ", "found \"three\""},
                    {kThree + "face 1 2 3\n", "line 4: ", "unknown statement \"face\""},
                    {kThree + "surf 0 1 0 1 1 2 3 4\n",
                     "line 4: ", "unknown statement \"surf\"; only polygons (v, f) are read"},
                    {kThree + "V 1 2 3\n", "line 4: ", "unknown statement \"V\""},
                    {"g a \\\n b\nx\n", "line 3: ", "unknown statement \"x\""},
                    {"v 1 2 3\r\n# c\r\nv 1 2\r\n", "line 3: ", "found 2 numbers"},
                    {"v 1 2 3\r# c\rv 1 2\r", "line 3: ", "found 2 numbers"},
                    {"a\r\r\nb\n", "line 1: ", "unknown statement \"a\""},
                    {std::string("v 1 2 3\n\0\n", 10), "line 2: ", "unknown statement \"\\x00\""},
                });
  }

  TEST_CASE("more triangles or vertices than there are ids are refused") {
    const std::string text = kThree + "f 1 2 3 1 2\n";
    CHECK(contains(error_of_reading("bad.obj", text, {.triangles = 2}), "line 4: more than 2 triangles"));
    CHECK(contains(error_of_reading("bad.obj", text, {.vertices = 2}), "line 3: more than 2 vertices"));
    CHECK(error_of_reading("bad.obj", text, {.vertices = 3, .triangles = 3}) == "no error");
  }
}
