#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io_util.h"
#include "mesh_files.h"

using namespace plumb;
using namespace plumb::test;

namespace {

using Triangles = std::vector<glm::uvec3>;
using Points = std::vector<glm::vec3>;

// A degenerate triangle and two equal ones among them.
const TriangleMesh kMesh = {{{0, 0, 0}, {1, 0.5f, 0}, {0, 1, -1e-40f}, {1, 1, 3}},
                            {{0, 1, 2}, {2, 1, 3}, {3, 3, 3}, {0, 1, 2}}};

Loaded read(const std::string& bytes) { return read_exact("a.stl", bytes); }

void check_mesh(const Loaded& loaded) {
  CHECK(same_mesh(loaded.mesh, separate_corners(kMesh)));
  CHECK(loaded.report.vertices == 12);
  CHECK(loaded.report.faces == 4);
  CHECK(loaded.report.triangles == 4);
}

std::string facet(const std::string& vertices, const std::string& normal = "0 0 1") {
  return "facet normal " + normal + "\nouter loop\n" + vertices + "endloop\nendfacet\n";
}

const std::string kThree = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";

}  // namespace

TEST_SUITE("stl") {
  TEST_CASE("a text and a binary file give each triangle its own vertices, in file order") {
    check_mesh(read(make_stl_text(kMesh)));
    check_mesh(read(make_stl_binary(kMesh)));
  }

  TEST_CASE("a binary file may begin with \"solid\"") {
    for (const char filler : {'\0', ' ', 'x', '\n'}) {
      check_mesh(read(make_stl_binary(kMesh, "solid", filler)));
      check_mesh(read(make_stl_binary(kMesh, "solid mesh\nfacet normal 0 0 1", filler)));
      check_mesh(read(make_stl_binary(kMesh, " \nSolid ", filler)));
      check_mesh(read(make_stl_binary(kMesh, "solid", filler) + "more"));
    }
    CHECK(read(make_stl_binary({}, "solid", ' ')).report.triangles == 0);
  }

  TEST_CASE("a text whose name is as long as a binary header is a text") {
    const std::string text = "solid " + std::string(200, 'x') + "\n" + facet(kThree) + "endsolid\n";
    CHECK(read(text).mesh.triangles == Triangles{{0, 1, 2}});
  }

  TEST_CASE("what follows the last triangle of a binary file does not matter") {
    for (const std::size_t more : {1u, 49u, 50u, 51u, 1000u}) {
      check_mesh(read(make_stl_binary(kMesh) + std::string(more, '\x7f')));
    }
  }

  TEST_CASE("keywords are in any case, between them may be any blanks and line ends") {
    std::string upper = make_stl_text(kMesh);
    for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    check_mesh(read(upper));
    for (const std::string end : {"\n", "\r\n", "\r", " \t\n\n"}) {
      std::string text;
      for (const char c : make_stl_text(kMesh)) text += c == '\n' ? end : std::string(1, c);
      check_mesh(read(text));
      while (text.ends_with(end)) text.resize(text.size() - end.size());
      check_mesh(read(text));
    }
    const std::string one_line =
        "Solid\nFACET Normal\t0 0 1 outer loop vertex 1 2 3 vertex\n4\n5 6 VERTEX 7 8 9 "
        "endLoop endfacet EndSolid";
    CHECK(read(one_line).mesh.positions == Points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
    CHECK(read("\xef\xbb\xbf\n\n  solid\nendsolid").report.triangles == 0);
  }

  TEST_CASE("a name is all that follows in the line") {
    const std::string text =
        "solid facet normal 1 # endsolid\n" + facet(kThree) + "endsolid solid facet x y\n";
    CHECK(read(text).mesh.triangles == Triangles{{0, 1, 2}});
  }

  TEST_CASE("several solids follow one another") {
    const std::string text = "solid a\n" + facet(kThree) + "endsolid a\n\nsolid b\nendsolid b\nSOLID\n" +
                             facet("vertex 1 2 3\nvertex 4 5 6\nvertex 7 8 9\n") + "endsolid other";
    const Loaded loaded = read(text);
    CHECK(loaded.mesh.triangles == Triangles{{0, 1, 2}, {3, 4, 5}});
    CHECK(loaded.mesh.positions[5] == glm::vec3(7, 8, 9));
    CHECK(loaded.report.faces == 2);
  }

  TEST_CASE("numbers are rounded once, nan and inf are kept and counted") {
    const std::string text =
        "solid\n" +
        facet("vertex 1.000000059604644775390625000001 1e-40 -1e-50\nvertex 0 0 0\nvertex +1 0 0\n") +
        facet("vertex nan 0 0\nvertex 1e50 0 0\nvertex 0 -inf 0\n", "nan inf -1e99") + "endsolid\n";
    const Loaded loaded = read(text);
    CHECK(loaded.mesh.positions[0].x == 1 + 0x1p-23f);
    CHECK(loaded.mesh.positions[0].y == 1e-40f);
    CHECK(same_bits(loaded.mesh.positions[0].z, -0.0f));
    CHECK(std::isnan(loaded.mesh.positions[3].x));
    CHECK(loaded.mesh.positions[4].x == std::numeric_limits<float>::infinity());
    CHECK(loaded.report.non_finite_vertices == 3);
    CHECK(loaded.report.unseen_triangles == 1);
  }

  TEST_CASE("the floats of a binary file keep all their bits") {
    TriangleMesh mesh = {{{}, {}, {}}, {{0, 1, 2}}};
    const std::vector<std::uint32_t> bits = {0x80000000u, 0x00000001u, 0x7fc12345u, 0xffc00000u, 0x7f800000u,
                                             0xff800000u, 0x7f7fffffu, 0x807fffffu, 0x3f800001u};
    for (int i = 0; i < 9; ++i) {
      mesh.positions[static_cast<std::size_t>(i / 3)][i % 3] =
          std::bit_cast<float>(bits[static_cast<std::size_t>(i)]);
    }
    const Loaded loaded = read(make_stl_binary(mesh));
    for (int i = 0; i < 9; ++i) {
      CHECK(std::bit_cast<std::uint32_t>(loaded.mesh.positions[static_cast<std::size_t>(i / 3)][i % 3]) ==
            bits[static_cast<std::size_t>(i)]);
    }
    CHECK(loaded.report.non_finite_vertices == 2);
    CHECK(loaded.report.unseen_triangles == 1);
  }
}

TEST_SUITE("stl errors") {
  TEST_CASE("a wrong text is refused with its line") {
    const std::string start = "solid a\n";
    const std::string end = "endsolid a\n";
    const std::string good = facet(kThree);
    check_cases(
        "bad.stl",
        {
            {"solid", "line 1: ", "expected \"facet\" or \"endsolid\", but the file ends; it is cut short"},
            {start + good, "line 9: ", "expected \"facet\" or \"endsolid\", but the file ends"},
            {start + good + "endsoli", "line 9: ", "expected \"facet\" or \"endsolid\", found \"endsoli\""},
            {start + "face normal 0 0 1\n", "line 2: ", "expected \"facet\" or \"endsolid\", found \"face\""},
            {start + "# made by\n" + good, "line 2: ", "found \"#\""},
            {start + "color 1 0 0\n" + good, "line 2: ", "found \"color\""},
            {start + "facet 0 0 1\n", "line 2: ", "expected \"normal\", found \"0\""},
            {start + "facet\n\nnorm 0 0 1\n", "line 4: ", "expected \"normal\", found \"norm\""},
            {start + facet(kThree, "0 0"), "line 3: ", "expected a number, found \"outer\""},
            {start + facet(kThree, "0 0 1 0"), "line 2: ", "expected \"outer\", found \"0\""},
            {start + facet(kThree, "0 0 up"), "line 2: ", "expected a number, found \"up\""},
            {start + "facet normal 0 0 1\nouter\nvertex 0 0 0\n",
             "line 4: ", "expected \"loop\", found \"vertex\""},
            {start + facet("vertex 0 0 0\nvertex 1 0 0\n"),
             "line 6: ", "expected \"vertex\", found \"endloop\""},
            {start + facet(kThree + "vertex 1 1 1\n"), "line 7: ", "expected \"endloop\", found \"vertex\""},
            {start + facet("vertex 0 0\nvertex 1 0 0\nvertex 0 1 0\n"),
             "line 5: ", "a number, found \"vertex\""},
            {start + facet("vertex 0 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"),
             "line 4: ", "\"vertex\", found \"0\""},
            {start + facet("vertex 0 zero 0\n"), "line 4: ", "expected a number, found \"zero\""},
            {start + facet("vertex 0 1,5 0\n"), "line 4: ", "expected a number, found \"1,5\""},
            {start + facet("vertex 0 0x1 0\n"), "line 4: ", "expected a number, found \"0x1\""},
            {start + facet("vertexes 0 1 0\n"), "line 4: ", "expected \"vertex\", found \"vertexes\""},
            {start + facet("vertex 0 1"), "line 4: ", "expected a number, found \"1endloop\""},
            {start + "facet normal 0 0 1\nouter loop\n" + kThree + "endfacet\n",
             "line 7: ", "expected \"endloop\""},
            {start + "facet normal 0 0 1\nouter loop\n" + kThree + "endloop\n" + good,
             "line 8: ", "expected \"endfacet\", found \"facet\""},
            {start + good + end + good, "line 10: ", "expected \"solid\", found \"facet\""},
            {start + good + end + "more\n", "line 10: ", "expected \"solid\", found \"more\""},
            {start + good + end + start + good, "line 18: ", "but the file ends"},
            {start + "solid b\n", "line 2: ", "expected \"facet\" or \"endsolid\", found \"solid\""},
            {"solid a " + good + end, "line 2: ", "expected \"facet\" or \"endsolid\", found \"outer\""},
            {"solid a\r\n" + facet("vertex\r\n0 0 x\r\n"), "line 5: ", "found \"x\""},
            {"solid a\r" + facet("vertex\r0 0 x\r"), "line 5: ", "found \"x\""},
            {start + "\x13"
                     "acet normal",
             "line 2: ", "found \"\\x13acet\""},
            {start + "facet normal " + std::string(100, 'x'), "line 2: ", "a number, found \"xxx"},
        });
  }

  TEST_CASE("a binary file that is cut short or no STL file is refused with its byte") {
    std::string many = make_stl_binary(kMesh);
    many.replace(80, 4, "\xff\xff\xff\xff");
    const std::string good = make_stl_binary(kMesh);
    check_cases(
        "bad.stl",
        {
            {"", "byte 0: ", "the file ends within the 84 bytes"},
            {"soli", "byte 4: ", "the file ends within the 84 bytes"},
            {"solidity\nendsolid\n", "byte 18: ", "a text begins with \"solid\""},
            {good.substr(0, 83), "byte 83: ", "the file ends within the 84 bytes"},
            {good.substr(0, 84),
             "byte 80: ", "the count of triangles claims 4 rows of at least 50 bytes, but only 0 bytes"},
            {good.substr(0, good.size() - 1), "byte 80: ", "claims 4 rows"},
            {make_stl_binary(kMesh, "solid").substr(0, 283),
             "byte 80: ", "but only 199 bytes are left for it; the file is cut short"},
            {many, "byte 80: ", "the count of triangles claims 4294967295 rows"},
            {facet(kThree) + facet(kThree), "byte 80: ", "or is a text that does not begin with \"solid\""},
        });
  }

  TEST_CASE("more triangles or vertices than there are ids are refused") {
    const std::string text = "solid\n" + facet(kThree) + facet(kThree) + "endsolid\n";
    CHECK(contains(error_of_reading("bad.stl", text, {.triangles = 1}), "line 13: more than 1 triangles"));
    CHECK(contains(error_of_reading("bad.stl", text, {.vertices = 4}), "line 12: more than 4 vertices"));
    CHECK(error_of_reading("bad.stl", text, {.vertices = 6, .triangles = 2}) == "no error");
    const std::string binary = make_stl_binary(kMesh);
    CHECK(contains(error_of_reading("bad.stl", binary, {.triangles = 3}), "byte 80: more than 3 triangles"));
    CHECK(contains(error_of_reading("bad.stl", binary, {.vertices = 11}), "byte 80: more than 11 vertices"));
    CHECK(error_of_reading("bad.stl", binary, {.vertices = 12, .triangles = 4}) == "no error");
  }
}
