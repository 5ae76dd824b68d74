#include <doctest/doctest.h>

#include <array>
#include <sstream>
#include <vector>

#include "io_util.h"
#include "mesh_files.h"
#include "plumb/io.h"
#include "ply_util.h"
#include "support/fp_modes.h"

using namespace plumb;
using namespace plumb::test;

namespace fs = std::filesystem;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
constexpr bool kAddressSanitizer = __has_feature(address_sanitizer);
#else
constexpr bool kAddressSanitizer = false;
#endif

struct Scene {
  std::string name;
  std::size_t triangles, vertices;
};

std::size_t number(std::string text) {
  std::erase(text, ',');
  return std::stoul(text);
}

// The table "Meshes" of the scenes' README: | `name` | triangles | vertices | ...
std::vector<Scene> scenes_of(const fs::path& readme) {
  std::vector<Scene> scenes;
  std::ifstream in(readme);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string bar, name, triangles, vertices;
    words >> bar >> name >> bar >> triangles >> bar >> vertices;
    const bool counts = !triangles.empty() && triangles.find_first_not_of("0123456789,") == std::string::npos;
    if (line.starts_with("| `") && counts) {
      scenes.push_back({name.substr(1, name.size() - 2), number(triangles), number(vertices)});
    }
  }
  return scenes;
}

}  // namespace

TEST_SUITE("load_mesh") {
  TEST_CASE("the extension, in any case, chooses the reader") {
    const TempDir dir;
    const std::string ply = make_ply("binary_little_endian", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* name : {"a.ply", "a.PLY", "a.b.Ply"}) {
      CHECK(load_mesh(dir.write(name, ply)).triangles == std::vector<glm::uvec3>{{0, 1, 2}});
    }
    for (const char* name : {"a.obj", "A.OBJ"}) {
      MeshReport report;
      CHECK(load_mesh(dir.write(name, obj), &report).triangles == std::vector<glm::uvec3>{{0, 1, 2}});
      CHECK(report.vertices == 3);
      CHECK(report.faces == 1);
      CHECK(report.triangles == 1);
    }
    for (const char* name : {"a.off", "A.OFF"}) {
      CHECK(load_mesh(dir.write(name, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n")).triangles ==
            std::vector<glm::uvec3>{{2, 1, 0}});
    }
    for (const char* name : {"a.stl", "A.STL"}) {
      CHECK(load_mesh(dir.write(name, make_stl_binary({{{1, 2, 3}}, {{0, 0, 0}}}))).positions ==
            std::vector<glm::vec3>(3, {1, 2, 3}));
    }
  }

  TEST_CASE("what is no mesh file is refused by name") {
    const TempDir dir;
    const std::string none = (dir.path() / "none.ply").string();
    CHECK(error_of_loading(none).starts_with(none + ": "));
    CHECK(contains(error_of_loading(none), "No such file"));
    CHECK(contains(error_of_loading(""), "No such file"));
    CHECK(contains(error_of_loading(dir.path()), dir.path().string() + ": is a directory"));
    fs::create_directory(dir.path() / "dir.ply");
    CHECK(contains(error_of_loading(dir.path() / "dir.ply"), "dir.ply: is a directory"));
    CHECK(contains(error_of_loading("/dev/null"), "/dev/null: is not a regular file"));
    CHECK(contains(error_of_loading(dir.write("empty.ply", "")), "empty.ply: the file is empty"));
    CHECK(contains(error_of_loading(dir.write("empty.obj", "")), "empty.obj: the file is empty"));
    CHECK(contains(error_of_loading(dir.write("empty.stl", "")), "empty.stl: the file is empty"));
    CHECK(contains(error_of_loading(dir.write("empty.off", "")), "empty.off: the file is empty"));
    CHECK(contains(error_of_loading(dir.write("a.xyz", "v 0 0 0\n")),
                   "a.xyz: the extension \".xyz\" names no mesh format; known: .ply, .obj, .stl, .off"));
    CHECK(contains(error_of_loading(dir.write("ply", "ply\n")), "the extension \"\" names no mesh format"));
  }

  TEST_CASE("the error of a reader names the path and the place") {
    const TempDir dir;
    const fs::path path = dir.write("bad.obj", "v 0 0 0\nf 1 1 x\n");
    CHECK(error_of_loading(path).starts_with(path.string() + ": line 2: "));
  }

  TEST_CASE("a file that may not be read is refused") {
    const TempDir dir;
    const fs::path path = dir.write("secret.ply", "ply\n");
    CHECK(
        contains(error_of_loading_unreadable(dir, path), "secret.ply: cannot be opened: Permission denied"));
  }

  TEST_CASE("a file larger than memory is refused") {
    const TempDir dir;
    const fs::path path = dir.write("large.ply", "ply\n");
    std::error_code error;
    fs::resize_file(path, std::uintmax_t{1} << 43, error);  // a hole, nothing is stored
    if (error || kAddressSanitizer) {
      MESSAGE("skipped: no file of 8 TiB can be made here, or the sanitizer ends a program that asks for it");
      return;
    }
    CHECK(contains(error_of([&] { load_mesh(path); }), "large.ply: there is not enough memory"));
    const auto ignore = [](MeshView, std::uint32_t) {};
    CHECK(contains(error_of([&] { stream_mesh(path, ignore); }),
                   "large.ply: byte 16777216: the header goes on"));
  }

  TEST_CASE("the caller's floating-point mode changes nothing and is kept") {
    const TempDir dir;
    const std::vector<std::array<double, 3>> vertices = {{1e-40, 0.1, 1 + 0x1p-24},
                                                         {-1e-45, 16777217, 1e-310}};
    std::vector<fs::path> paths;
    for (const std::string& format : kPlyFormats) {
      paths.push_back(dir.write(format + ".ply", make_ply(format, vertices, {}, {"double", "uchar", "int"})));
    }
    paths.push_back(dir.write("a.obj", "v 1e-40 0.1 1.000000059604644775390625\nv -1e-45 16777217 1e-310\n"));
    paths.push_back(
        dir.write("a.off", "OFF 2 0\n1e-40 0.1 1.000000059604644775390625\n-1e-45 16777217 1e-310\n"));
    paths.push_back(dir.write("a.stl",
                              "solid\nfacet normal 0 0 1e-40 outer loop\nvertex 1e-40 0.1 "
                              "1.000000059604644775390625\nvertex -1e-45 16777217 1e-310\nvertex 0 0 0\n"
                              "endloop endfacet endsolid"));
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      for (const fs::path& path : paths) {
        const TriangleMesh mesh = hard::under_mode(mode.bits, [&] { return load_mesh(path); });
        CHECK(mesh.positions.at(0) == glm::vec3(1e-40f, 0.1f, 1.0f));
        CHECK(mesh.positions.at(1) == glm::vec3(-1e-45f, 16777216.0f, 0.0f));
      }
    }
  }

  TEST_CASE("the shared scenes load with their counts") {
    const fs::path folder = fs::path(PLUMB_SHARED_DIR) / "scenes";
    if (!fs::exists(folder / "README.md")) {
      MESSAGE("skipped: no scenes in " << folder.string());
      return;
    }
    const std::vector<Scene> scenes = scenes_of(folder / "README.md");
    CHECK(scenes.size() == 16);
    for (const Scene& scene : scenes) {
      CAPTURE(scene.name);
      MeshReport report;
      const TriangleMesh mesh = load_mesh(folder / (scene.name + ".ply"), &report);
      CHECK(mesh.triangles.size() == scene.triangles);
      CHECK(mesh.positions.size() == scene.vertices);
      CHECK(report.faces == scene.triangles);
      CHECK(report.unseen_triangles == (scene.name == "near_ties" ? 2 : 0));
    }
  }

  TEST_CASE("the shared scenes are the same as OFF and, with a vertex for every corner, as STL") {
    const fs::path folder = fs::path(PLUMB_SHARED_DIR) / "scenes";
    if (!fs::exists(folder / "README.md")) {
      MESSAGE("skipped: no scenes in " << folder.string());
      return;
    }
    const TempDir dir;
    for (const Scene& scene : scenes_of(folder / "README.md")) {
      CAPTURE(scene.name);
      const TriangleMesh mesh = load_mesh(folder / (scene.name + ".ply"));
      CHECK(same_mesh(load_mesh(dir.write("a.off", make_off(mesh))), mesh));
      const TriangleMesh corners = separate_corners(mesh);
      CHECK(same_mesh(load_mesh(dir.write("text.stl", make_stl_text(mesh))), corners));
      CHECK(same_mesh(load_mesh(dir.write("binary.stl", make_stl_binary(mesh))), corners));
    }
  }
}
