#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "io_util.h"
#include "ply_util.h"

using namespace plumb;
using namespace plumb::test;

namespace {

// Three vertices and a face whose body is given.
std::string three_and(const std::string& face) {
  return ascii("element vertex 3\n" + kVertexHeader + kFaceHeader + "end_header\n0 0 0\n1 0 0\n0 1 0\n" +
               face);
}

void check_cases(const std::vector<Case>& cases) { test::check_cases("bad.ply", cases); }

}  // namespace

TEST_SUITE("ply errors") {
  TEST_CASE("a wrong header is refused with its line") {
    const std::string vertex = "element vertex 3\n" + kVertexHeader;
    check_cases({
        {"", "line 1: ", "begins with a line \"ply\""},
        {"solid\n", "line 1: ", "begins with a line \"ply\""},
        {"plyx\nend_header\n", "line 1: ", "begins with a line \"ply\""},
        {"ply\rformat ascii 1.0\rend_header\r", "line 1: ", "the file ends before the header does"},
        {"ply", "line 1: ", "the file ends before the header does"},
        {"ply\n", "line 2: ", "the file ends before the header does"},
        {"ply\nformat ascii 1.0\nend_header", "line 3: ", "the file ends before the header does"},
        {"ply\nend_header\n", "line 2: ", "no line \"format\""},
        {"ply\nelement vertex 0\nformat ascii 1.0\nend_header\n", "line 3: ", "before the elements"},
        {"ply\nformat ascii 1.0\nformat ascii 1.0\nend_header\n", "line 3: ", "a second line \"format\""},
        {"ply\nformat ascii\nend_header\n", "line 2: ", "format NAME 1.0"},
        {"ply\nformat ebcdic 1.0\nend_header\n", "line 2: ", "unknown format \"ebcdic\""},
        {"ply\nformat ascii 2.0\nend_header\n", "line 2: ", "unknown format version \"2.0\""},
        {ascii("elephant\nend_header\n"), "line 3: ", "unknown header statement \"elephant\""},
        {ascii("end_header now\n"), "line 3: ", "unknown header statement \"end_header\""},
        {ascii("property float x\nend_header\n"), "line 3: ", "a property before the first element"},
        {ascii("element vertex\nend_header\n"), "line 3: ", "element NAME COUNT"},
        {ascii("element vertex many\nend_header\n"), "line 3: ", "expected a count, found \"many\""},
        {ascii("element vertex 3.5\nend_header\n"), "line 3: ", "expected a count, found \"3.5\""},
        {ascii("element vertex -1\nend_header\n"), "line 3: ", "expected a count, found \"-1\""},
        {ascii("element vertex 99999999999999999999\nend_header\n"), "line 3: ", "expected a count"},
        {ascii("element a 0\nelement a 0\nend_header\n"), "line 4: ", "a second element \"a\""},
        {ascii("element a 0\nproperty float\nend_header\n"), "line 4: ", "property TYPE NAME"},
        {ascii("element a 0\nproperty\nend_header\n"), "line 4: ", "property TYPE NAME"},
        {ascii("element a 0\nproperty list int a\nend_header\n"), "line 4: ", "property TYPE NAME"},
        {ascii("element a 0\nproperty half x\nend_header\n"), "line 4: ", "unknown type \"half\""},
        {ascii("element a 0\nproperty list half int x\nend_header\n"), "line 4: ", "unknown type \"half\""},
        {ascii("element a 0\nproperty int x\nproperty float x\nend_header\n"),
         "line 5: ", "a second property \"x\""},
        {ascii("element a 0\nproperty list float int x\nend_header\n"),
         "line 4: ", "length must be of an integer type"},
        {ascii("element vertex 0\nproperty list uchar float x\nend_header\n"),
         "line 4: ", "must not be a list"},
        {ascii("element face 0\nproperty int vertex_index\nend_header\n"), "line 4: ", "must be a list"},
        {ascii("element face 0\nproperty list uchar float vertex_index\nend_header\n"),
         "line 4: ", "indices must be of an integer type"},
        {ascii(kFaceHeader + "property list uchar int vertex_index\nend_header\n"),
         "line 5: ", "a second property \"vertex_index\""},
        {ascii("element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
         "line 3: ", "properties x, y and z"},
        {ascii(vertex + "element face 1\nproperty uchar red\nend_header\n0 0 0\n1 0 0\n0 1 0\n7\n"),
         "line 7: ", "\"vertex_indices\""},
        {ascii("element vertex 4294967296\n" + kVertexHeader + "end_header\n"),
         "line 3: ", "more than 4294967295 vertices"},
        {ascii(vertex + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"),
         "line 7: ", "triangle strips"},
    });
  }

  TEST_CASE("counts that the file cannot hold are refused before anything is allocated") {
    for (const std::string& format : kPlyFormats) {
      for (const std::string count : {"2", "900000000", "4294967295"}) {
        const std::string start = "ply\nformat " + format + " 1.0\n";
        const std::string padding(format == "ascii" ? 6 : 12, '0');
        check_cases({{start + "element vertex " + count + "\n" + kVertexHeader + "end_header\n" + padding,
                      "line 3: ", "element \"vertex\" claims " + count + " rows"}});
      }
      for (const std::string count : {"1000", "9223372036854775807"}) {
        std::string bytes = make_ply(format, kVertices, kFaces);
        bytes.replace(bytes.find("face 4"), 6, "face " + count);
        check_cases({{bytes, "line 7: ", "element \"face\" claims " + count + " rows"}});
      }
    }
  }

  TEST_CASE("one row more than the shortest rows leave room for is too many") {
    for (const std::string& format : kPlyFormats) {
      const std::string bytes = make_ply(format, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
      REQUIRE(error_of_reading("good.ply", bytes) == "no error");
      for (const std::string claim : {"vertex 3", "face 2"}) {
        std::string wrong = bytes;
        ++wrong[wrong.find(claim) + claim.size() - 1];
        check_cases({{wrong, "line 7: ", "element \"face\" claims"}});
      }
    }
  }

  TEST_CASE("a wrong row of a text is refused with its line") {
    const std::string start = ascii("element vertex 2\n" + kVertexHeader + "end_header\n");
    check_cases({
        {start + "0 0 0\n1 zero 0\n",
         "line 9 (vertex 1): ", "property \"y\": expected a value of type float, found \"zero\""},
        {start + "0 0 0\n1 0x1 0\n", "line 9 (vertex 1): ", "found \"0x1\""},
        {start + "0 0 0\n\n1 0\n",
         "line 10 (vertex 1): ", "the line ends where a value of property \"z\" should be"},
        {start + "0 0\n0 1 0 0\n",
         "line 8 (vertex 0): ", "the line ends where a value of property \"z\" should be"},
        {start + "0 0 0 7\n1 0 0\n", "line 8 (vertex 0): ", "the line goes on after its last value: \"7\""},
        {start + "0.00000 0 0\n", "line 9 (vertex 1): ", "the file ends here"},
        {three_and("3 0 1 2.5\n"), "line 13 (face 0): ", "expected a value of type int, found \"2.5\""},
        {three_and("3 0 1 99999999999999999999\n"), "line 13 (face 0): ", "expected a value of type int"},
        {three_and("3 0 1 2147483648\n"), "line 13 (face 0): ", "expected a value of type int"},
        {three_and("300 0 1 2\n"), "line 13 (face 0): ", "expected a value of type uchar, found \"300\""},
        {three_and("-3 0 1 2\n"), "line 13 (face 0): ", "expected a value of type uchar, found \"-3\""},
        {three_and("4 0 1 2\n"), "line 13 (face 0): ", "the line ends"},
        {three_and("2 0 1 2\n"), "line 13 (face 0): ", "3 corners or more, this one has 2"},
        {three_and("0      \n "), "line 13 (face 0): ", "3 corners or more, this one has 0"},
    });
  }

  TEST_CASE("a wrong row of a binary file is refused with its byte") {
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
      const std::string bytes = make_ply(format, kVertices, kFaces, {"float", "int", "int"});
      const std::string before = bytes.substr(0, bytes.find("end_header\n") + 11 + 5 * 12);
      const auto with_faces = [&](const std::vector<int>& values) {
        std::string result = before;
        for (const int value : values) put(result, format, "int", value);
        return result + std::string(64, '\0');  // so that the counts fit
      };
      const auto place = [&](int face, int ints) {
        return "face " + std::to_string(face) + " (before byte " +
               std::to_string(before.size() + 4 * static_cast<std::size_t>(ints)) + "): ";
      };
      check_cases({
          {with_faces({3, 0, 1, 5}), place(0, 4), "vertex index 5 is out of range; there are 5 vertices"},
          {with_faces({3, 0, 1, 2, 3, -1, 1, 2}), place(1, 6), "vertex index -1 is out of range"},
          {with_faces({-1, 0, 1, 2}), place(0, 1), "negative length -1"},
          {with_faces({2, 0, 1}), place(0, 1), "3 corners or more, this one has 2"},
          {with_faces({2147483647}), place(0, 17), "the file ends within property \"vertex_indices\""},
      });
    }
  }

  TEST_CASE("an index out of range is refused in every format and type") {
    for (const std::string& format : kPlyFormats) {
      for (const std::string index : {"uchar", "ushort", "uint", "int"}) {
        const std::string error = error_of_reading(
            "bad.ply", make_ply(format, kVertices, {{0, 1, 2}, {0, 1, 5}}, {"float", "uchar", index}));
        CHECK(error.starts_with("bad.ply: "));
        CHECK(contains(error, "face 1"));
        CHECK(contains(error, "vertex index 5 is out of range"));
      }
    }
  }

  TEST_CASE("more triangles or vertices than there are ids are refused") {
    detail::MeshLimits limits;
    limits.triangles = 5;
    const std::string bytes = make_ply("ascii", kVertices, kFaces);
    CHECK(contains(error_of_reading("bad.ply", bytes, limits), "line 18 (face 3): more than 5 triangles"));
    limits = {.vertices = 4};
    CHECK(contains(error_of_reading("bad.ply", bytes, limits), "line 3: more than 4 vertices"));
    limits = {.vertices = 5, .triangles = 6};
    CHECK(error_of_reading("bad.ply", bytes, limits) == "no error");
  }
}
