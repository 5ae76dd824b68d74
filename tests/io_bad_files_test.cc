#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "io_util.h"
#include "mesh_files.h"
#include "ply_util.h"

// docs/bad-files.md: bad files of all formats and what load_mesh answers, word for word. When an answer
// changes, write the page anew: io_test --no-skip --test-case="the page of bad files is written anew"

using namespace plumb;
using namespace plumb::test;

namespace fs = std::filesystem;

namespace {

struct BadFile {
  std::string name, what, bytes;
};

const TriangleMesh kMesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
const std::vector<std::array<double, 3>> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::string kBinaryPly = "binary_little_endian";

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by);
}

// The count of a binary STL file as it would be for this many triangles, in 1000 bytes.
std::string stl_claiming(std::uint32_t triangles) {
  std::string bytes(80, '\0');
  put_binary(bytes, triangles, false);
  bytes.resize(1000, '\0');
  return bytes;
}

std::vector<BadFile> bad_ply() {
  const std::string text = make_ply("ascii", kCorners, {{0, 1, 2}});
  const std::string binary = make_ply(kBinaryPly, kCorners, {{0, 1, 2}});
  const std::string last_face = "3 0 1 2";
  const std::string padding(1000, '0');
  return {
      {"not_ply.ply", "a text that is no PLY", "hello\n"},
      {"header_cut.ply", "cut short in the header", text.substr(0, 60)},
      {"no_format.ply", "a header without a format", replaced(text, "format ascii 1.0\n", "")},
      {"version.ply", "a format of the future", replaced(text, "1.0", "2.0")},
      {"type.ply", "an unknown type", replaced(text, "float x", "half x")},
      {"no_z.ply", "vertices without z", replaced(text, "property float z\n", "")},
      {"strips.ply", "triangle strips",
       replaced(text, "end_header", "element tristrips 1\nproperty list int int vertex_indices\nend_header")},
      {"10_gb_vertices.ply", "1 KB that claims 10 GB of vertices",
       replaced(binary, "vertex 3", "vertex 833333334") + padding},
      {"10_gb_faces.ply", "1 KB that claims 10 GB of faces",
       replaced(binary, "face 1", "face 769230770") + padding},
      {"2_to_32.ply", "more vertices than 32 bits can number",
       replaced(text, "vertex 3", "vertex 4294967296")},
      {"word.ply", "a coordinate that is a word", replaced(text, "1 0 0", "1 up 0")},
      {"two_of_three.ply", "a vertex of 2 coordinates", replaced(text, "1 0 0", "1 0") + "   "},
      {"index.ply", "an index out of range, as text", replaced(text, last_face, "3 0 1 3")},
      {"negative.ply", "a negative index", replaced(text, last_face, "3 0 1 -1")},
      {"index_binary.ply", "an index out of range, binary", make_ply(kBinaryPly, kCorners, {{0, 1, 7}})},
      {"two_corners.ply", "a polygon of 2 corners", replaced(text, last_face, "2 0 1  ")},
      {"text_cut.ply", "a text cut short within the last row", replaced(text, last_face + "\n", "3   0 1 ")},
      {"list_cut.ply", "a list longer than the file",
       replaced(binary, std::string("\3\0\0", 3), {"\77\0\0", 3})},
  };
}

std::vector<BadFile> bad_obj() {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  return {
      {"vertex.obj", "a vertex of 2 coordinates", "v 0 0\n"},
      {"word.obj", "a coordinate that is a word", "v 0 0 0\nv 1 zero 0\n"},
      {"almost_nan.obj", "almost NaN", "v nano 0 0\n"},
      {"comma.obj", "decimal commas", "v 0,5 1,5 2,5\n"},
      {"index.obj", "an index out of range", three + "f 1 2 4\n"},
      {"zero.obj", "an index 0", three + "f 0 1 2\n"},
      {"back.obj", "a negative index before the first vertex", three + "f -1 -2 -4\n"},
      {"two_corners.obj", "a polygon of 2 corners", three + "f 1 2\n"},
      {"cut.obj", "cut short within a face", three + "f 1 2 3/"},
      {"surface.obj", "a curved surface", three + "cstype bspline\n"},
      {"zeros.obj", "zero bytes in the place of text", std::string(16, '\0')},
  };
}

std::vector<BadFile> bad_stl() {
  const std::string text = make_stl_text(kMesh);
  const std::string binary = make_stl_binary(kMesh);
  return {
      {"not_stl.stl", "a short text that is no STL", "hello\n"},
      {"long_not_stl.stl", "a long text that is no STL", std::string(500, 'x')},
      {"no_end.stl", "a text cut short between facets", text.substr(0, text.find("endsolid"))},
      {"cut.stl", "a text cut short within a vertex", text.substr(0, text.find("vertex 1") + 8)},
      {"word.stl", "a coordinate that is a word", replaced(text, "vertex 1", "vertex one")},
      {"almost_nan.stl", "almost NaN", replaced(text, "vertex 1", "vertex nan(")},
      {"normal.stl", "a normal of 2 numbers", replaced(text, "normal 0 0 1", "normal 0 1")},
      {"two_corners.stl", "a loop of 2 corners", replaced(text, "  vertex 1 0 0\n", "")},
      {"four_corners.stl", "a loop of 4 corners", replaced(text, " endloop", "  vertex 1 1 0\n endloop")},
      {"colour.stl", "a statement of a dialect", replaced(text, "facet", "color 1 0 0\nfacet")},
      {"after.stl", "a facet after the last solid", text + text.substr(text.find("facet"))},
      {"binary_cut.stl", "a binary file cut short", binary.substr(0, binary.size() - 1)},
      {"solid_cut.stl", "a binary file cut short that begins with \"solid\"",
       make_stl_binary(kMesh, "solid").substr(0, 100)},
      {"10_gb.stl", "1 KB that claims 10 GB of triangles", stl_claiming(200000000)},
      {"most.stl", "1 KB that claims all that 32 bits can", stl_claiming(0xffffffffu)},
  };
}

std::vector<BadFile> bad_off() {
  const std::string text = make_off(kMesh);
  const std::string last_face = "3 0 1 2";
  return {
      {"not_off.off", "a text that is no OFF", "hello\n"},
      {"glued.off", "counts glued to the keyword", replaced(text, "OFF\n", "OFF")},
      {"4d.off", "vertices of 4 coordinates", "4" + text},
      {"binary.off", "a binary file", "OFF BINARY\n" + std::string(12, '\0')},
      {"no_counts.off", "cut short before the counts", "OFF\n"},
      {"counts.off", "a count that is a word", replaced(text, "3 1 0", "3 one 0")},
      {"negative_count.off", "a negative count", replaced(text, "3 1 0", "-3 1 0")},
      {"10_gb_vertices.off", "1 KB that claims 10 GB of vertices",
       replaced(text, "3 1 0", "833333334 1 0") + std::string(1000, ' ')},
      {"10_gb_faces.off", "1 KB that claims 10 GB of faces",
       replaced(text, "3 1 0", "3 833333334 0") + std::string(1000, ' ')},
      {"word.off", "a coordinate that is a word", replaced(text, "1 0 0", "1 up 0")},
      {"two_of_three.off", "a vertex of 2 coordinates", replaced(text, "1 0 0", "1   0")},
      {"colour.off", "colours in a file that is no COFF", replaced(text, "1 0 0", "1 0 0 255 0 0")},
      {"index.off", "an index out of range", replaced(text, last_face, "3 0 1 3")},
      {"negative.off", "a negative index", replaced(text, last_face, "3 0 1 -1")},
      {"two_corners.off", "a polygon of 2 corners", replaced(text, last_face, "2 0 1  ")},
      {"cut.off", "cut short within the last face", replaced(text, last_face + "\n", "3   0 1 ")},
      {"one_short.off", "one face fewer than claimed", replaced(text, "3 1 0", "3 2 0") + "        "},
  };
}

std::vector<BadFile> all_bad_files() {
  std::vector<BadFile> all;
  for (const auto& files : {bad_ply(), bad_obj(), bad_stl(), bad_off()}) {
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

struct Answer {
  std::string name, what, answer;
};

// What load_mesh says, without the folder.
std::vector<Answer> answers() {
  const TempDir dir;
  const std::string prefix = dir.path().string() + "/";
  std::vector<Answer> result;
  const auto add = [&](const std::string& name, const std::string& what, std::string error) {
    if (error.starts_with(prefix)) error.erase(0, prefix.size());
    result.push_back({name, what, error});
  };
  add("missing.ply", "no such file", error_of_loading(dir.path() / "missing.ply"));
  fs::create_directory(dir.path() / "folder.obj");
  add("folder.obj", "a directory", error_of_loading(dir.path() / "folder.obj"));
  fs::create_symlink("/dev/null", dir.path() / "device.stl");
  add("device.stl", "a device", error_of_loading(dir.path() / "device.stl"));
  const fs::path secret = dir.write("unreadable.off", make_off(kMesh));
  add("unreadable.off", "a file that may not be read", error_of_loading_unreadable(dir, secret));
  add("mesh.xyz", "an unknown extension", error_of_loading(dir.write("mesh.xyz", "0 0 0\n")));
  add("mesh", "no extension", error_of_loading(dir.write("mesh", "0 0 0\n")));
  for (const char* name : {"empty.ply", "empty.obj", "empty.stl", "empty.off"}) {
    add(name, "an empty file", error_of_loading(dir.write(name, "")));
  }
  for (const BadFile& file : all_bad_files()) {
    add(file.name, file.what, error_of_loading(dir.write(file.name, file.bytes)));
  }
  return result;
}

std::string page(const std::vector<Answer>& rows) {
  std::string text =
      "# Bad files and what is answered\n\n"
      "Written by `tests/io_bad_files_test.cc`, which makes the files, loads them and fails when an answer\n"
      "is no longer the one below. `load_mesh` names the path it was given; here it is the file's name.\n\n"
      "| file | what it is | answer |\n|---|---|---|\n";
  for (const Answer& row : rows) text += "| " + row.name + " | " + row.what + " | `" + row.answer + "` |\n";
  return text;
}

const fs::path kPage = fs::path(PLUMB_DOCS_DIR) / "bad-files.md";

}  // namespace

TEST_SUITE("bad files") {
  TEST_CASE("each is refused by its name, and no two files have one name") {
    std::set<std::string> names;
    for (const Answer& row : answers()) {
      CAPTURE(row.name);
      CHECK(row.answer.starts_with(row.name + ": "));
      CHECK(row.answer.size() > row.name.size() + 10);
      CHECK(names.insert(row.name).second);
    }
    CHECK(names.size() >= 40);
  }

  TEST_CASE("the page of bad files says what is answered") {
    std::ifstream in(kPage, std::ios::binary);
    const std::string written{std::istreambuf_iterator<char>(in), {}};
    const bool up_to_date = written == page(answers());
    CHECK_MESSAGE(up_to_date, kPage.string(), " is out of date: see the top of this test's source");
  }

  TEST_CASE("the page of bad files is written anew" * doctest::skip()) {
    std::ofstream out(kPage, std::ios::binary);
    out << page(answers());
    CHECK(out.flush().good());
  }
}
