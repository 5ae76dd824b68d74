#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

#include "fuzz/targets.h"
#include "io_util.h"
#include "mesh_files.h"
#include "ply_util.h"

using namespace plumb;
using namespace plumb::test;

// Whatever the bytes: a reader returns a mesh whose indices are in range, or throws plumb::Error with
// the file's name (fuzz/targets.h). A sanitizer sees the rest.

namespace {

struct Sample {
  std::string extension;
  std::string bytes;
};

std::vector<Sample> samples() {
  const std::vector<std::array<double, 3>> vertices = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, 1e-40}, {1, 1, -3}};
  const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2}, {2, 1, 3, 0}, {3, 3, 3}};
  std::vector<Sample> result;
  for (const std::string& format : kPlyFormats) {
    result.push_back({".ply", make_ply(format, vertices, faces)});
    result.push_back({".ply", make_ply(format, vertices, faces, {"double", "uint", "ushort"})});
  }
  result.push_back(
      {".obj",
       "# c\nmtllib a.mtl\nv 0 0 0\nv 1 0.5 -1e-40\nv 0 1 0 1 0.5 0\r\nv 1 1 1\nvn 0 0 1\n"
       "f 1 2 3\nf 1/1 2/2 \\\n3/3 4/4\nf -1//1 -2//1 -3//1\nusemtl x\nf 4/1/1 3/1/1 2/1/1 # end\n"});
  result.push_back(
      {".off",
       "# c\nSTCNOFF # c\n4 3 # 7\n0 0 0 0 0 1 1 0 0 0 0\n1 0.5 -1e-40 0 0 1 1 0 0 .5 1 1\n\n"
       "0 1 0 0 0 1 1 0 0 .5 1 1\r\n1 1 1 0 0 1 1 0 0 1 1\n3 0 1 2\n4 2 1 3 0 255 0 0\n# c\n3 3 3 3\n"});
  const TriangleMesh mesh = {{{0, 0, 0}, {1, 0.5f, -1e-40f}, {0, 1, 0}, {1, 1, 1}},
                             {{0, 1, 2}, {2, 1, 3}, {3, 3, 3}}};
  result.push_back({".off", make_off(mesh)});
  result.push_back({".stl", make_stl_text(mesh)});
  result.push_back({".stl", make_stl_binary(mesh)});
  result.push_back({".stl", make_stl_binary(mesh, "solid", ' ')});
  return result;
}

bool is_obj(const Sample& sample) { return sample.extension == ".obj"; }

// Characters at the end of a sample that can go missing.
std::size_t needless_bytes(const Sample& sample) {
  if (sample.bytes.ends_with("endsolid mesh\n")) return std::string(" mesh\n").size();
  return sample.bytes.ends_with('\n') ? 1 : 0;
}

// Whether the bytes hold a mesh.
bool loads(const std::string& extension, std::string_view bytes) {
  bool loaded = false;
  CHECK(fuzz::fault_of_reader(extension, bytes, &loaded) == "");
  return loaded;
}

}  // namespace

TEST_SUITE("hostile mesh files") {
  TEST_CASE("a PLY, STL or OFF file cut short anywhere is refused, but for a text's last characters") {
    for (const Sample& sample : samples()) {
      if (is_obj(sample)) continue;
      REQUIRE(loads(sample.extension, sample.bytes));
      const std::size_t needed = sample.bytes.size() - needless_bytes(sample);
      for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
        CAPTURE(size);
        CHECK(loads(sample.extension, sample.bytes.substr(0, size)) == (size >= needed));
      }
    }
  }

  TEST_CASE("an OBJ file cut short anywhere is refused or is a shorter file") {
    const std::vector<Sample> all = samples();
    const Sample sample = *std::find_if(all.begin(), all.end(), is_obj);
    REQUIRE(loads(sample.extension, sample.bytes));
    std::set<bool> seen;
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      seen.insert(loads(sample.extension, sample.bytes.substr(0, size)));
    }
    CHECK(seen.size() == 2);
  }

  TEST_CASE("random bytes in the place of some do no harm") {
    std::mt19937_64 random(4);
    for (const Sample& sample : samples()) {
      int loaded = 0;
      for (int i = 0; i < 4000; ++i) {
        std::string bytes = sample.bytes;
        for (std::uint64_t flips = 1 + random() % 4; flips > 0; --flips) {
          char& byte = bytes[random() % bytes.size()];
          byte = random() % 2 == 0 ? static_cast<char>(random()) : "0123456789-+.e/ \n\r\\#"[random() % 21];
        }
        loaded += loads(sample.extension, bytes) ? 1 : 0;
      }
      CHECK(loaded > 0);
      CHECK(loaded < 4000);
    }
  }

  TEST_CASE("pieces put together at random do no harm") {
    std::mt19937_64 random(5);
    const std::vector<Sample> all = samples();
    for (int i = 0; i < 20000; ++i) {
      const Sample& a = all[random() % all.size()];
      const Sample& b = all[random() % all.size()];
      std::string bytes = a.bytes;
      const std::size_t from = random() % b.bytes.size();
      const std::size_t length = random() % 40;
      bytes.insert(random() % bytes.size(), b.bytes.substr(from, length));
      loads(a.extension, bytes);
    }
  }

  TEST_CASE("a header of very many names is read in good time") {
    std::string bytes = "ply\nformat ascii 1.0\n";
    for (int i = 0; i < 100000; ++i) bytes += "element e" + std::to_string(i) + " 0\n";
    for (int i = 0; i < 100000; ++i) bytes += "property int p" + std::to_string(i) + "\n";
    CHECK(loads(".ply", bytes + "end_header\n"));
  }
}
