#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "io_util.h"
#include "mesh_files.h"
#include "plumb/builtin.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/stream.h"
#include "ply_util.h"
#include "stream_check.h"
#include "support/fp_modes.h"

using namespace plumb;
using namespace plumb::test;

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLeast = std::size_t{1} << 20;

// So large that parts of the least memory are a fraction of it.
const BuiltinScene& scene() {
  static const BuiltinScene kScene = builtin_scene("terrain:40000");
  return kScene;
}

TriangleMesh shuffled(TriangleMesh mesh) {
  std::mt19937_64 random(11);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

StreamOptions least_memory() {
  StreamOptions options;
  options.memory_bytes = kLeast;
  return options;
}

// What the frame of a file in parts has otherwise than that in one piece.
void check_frame(const fs::path& path) {
  const Camera camera = scene().camera(160, 90);
  Frame whole(160, 90), streamed(160, 90);
  MeshReport expected;
  rasterize(load_mesh(path, &expected), camera, whole);
  REQUIRE(std::count(whole.id.begin(), whole.id.end(), kNone) < 160 * 90);

  Rasterizer rasterizer(camera);
  std::size_t parts = 0;
  const MeshReport report = stream_mesh(
      path,
      [&](MeshView part, std::uint32_t first_id) {
        rasterizer.draw(part, first_id);
        ++parts;
      },
      least_memory());
  rasterizer.resolve(streamed);
  CHECK(parts > 3);
  CHECK(same_report(report, expected));
  CHECK(compare(whole, streamed).equal());
}

}  // namespace

TEST_SUITE("stream_mesh") {
  TEST_CASE("a frame of a file in parts is that of the file in one piece, whatever the format") {
    const TempDir dir;
    const TriangleMesh& mesh = scene().mesh;
    for (const std::string& format : kPlyFormats) {
      CAPTURE(format);
      check_frame(dir.write("a.ply", make_ply_of(mesh, format)));
      check_frame(dir.write("a.ply", make_ply_of(mesh, format, true)));
    }
    for (const ObjOrder order : {ObjOrder::VerticesFirst, ObjOrder::FacesFirst, ObjOrder::Mixed}) {
      check_frame(dir.write("a.obj", make_obj(mesh, order)));
    }
    check_frame(dir.write("a.off", make_off(mesh)));
    check_frame(dir.write("text.stl", make_stl_text(mesh)));
    check_frame(dir.write("binary.stl", make_stl_binary(mesh)));
  }

  TEST_CASE("triangles may come in any order") {
    const TempDir dir;
    const TriangleMesh mesh = shuffled(scene().mesh);
    check_frame(dir.write("a.ply", make_ply_of(mesh, kPlyFormats.at(1))));
    check_frame(dir.write("a.ply", make_ply_of(mesh, kPlyFormats.at(2), true)));
    check_frame(dir.write("a.off", make_off(mesh)));
    check_frame(dir.write("a.obj", make_obj(mesh, ObjOrder::Mixed)));
  }

  TEST_CASE("parts of every size give the mesh, with windows of every size") {
    TriangleMesh mesh = builtin_scene("terrain:200").mesh;
    mesh.positions[7].y = std::numeric_limits<float>::quiet_NaN();
    for (const bool shuffle : {false, true}) {
      if (shuffle) mesh = shuffled(mesh);
      const std::string ply = make_ply_of(mesh, kPlyFormats.at(1));
      const std::string obj = make_obj(mesh, ObjOrder::Mixed);
      for (std::size_t size = 1; size < mesh.triangles.size() + 2; size = size * 5 / 4 + 1) {
        CAPTURE(size);
        const Outcome of_ply =
            outcome_of([&](Outcome& o) { o.mesh = detail::read_ply(ply, "a.ply", o.report); });
        CHECK(of_ply.report.unseen_triangles > 2);
        detail::StreamSizes sizes = smallest_sizes("", size);
        sizes.window_bytes = 128 + size;
        CHECK(stream_difference("a.ply", ply, {}, of_ply, sizes) == "");
        const Outcome of_obj =
            outcome_of([&](Outcome& o) { o.mesh = detail::read_obj(obj, "a.obj", o.report); });
        CHECK(stream_difference("a.obj", obj, {}, of_obj, sizes) == "");
      }
    }
  }

  TEST_CASE("ids go on from file to file, and never reach kNone") {
    const TempDir dir;
    const fs::path path = dir.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\nf 1 3 2\n");
    StreamOptions options;
    for (const std::uint32_t first : {7u, kNone - 3}) {
      options.first_id = first;
      std::vector<std::uint32_t> ids;
      stream_mesh(
          path, [&](MeshView, std::uint32_t first_id) { ids.push_back(first_id); }, options);
      CHECK(ids == std::vector<std::uint32_t>{first});
    }
    options.first_id = kNone - 2;
    const std::string error = error_of([&] {
      stream_mesh(
          path, [](MeshView, std::uint32_t) {}, options);
    });
    CHECK(contains(error,
                   "a.obj: line 6: more than 2 triangles, whose ids begin at 4294967293 and must stay "
                   "below 4294967295; split the scene"));
  }

  TEST_CASE("several files are one scene") {
    const TempDir dir;
    const TriangleMesh& mesh = scene().mesh;
    const Camera camera = scene().camera(160, 90);
    Frame whole(160, 90), streamed(160, 90);
    rasterize(mesh, camera, whole);

    Rasterizer rasterizer(camera);
    StreamOptions options = least_memory();
    const std::size_t count = mesh.triangles.size();
    const std::vector<std::size_t> ends = {count / 5, count / 2, count / 2 + 1, count};
    std::size_t first = 0;
    for (const std::size_t end : ends) {
      TriangleMesh piece{mesh.positions, {}};
      piece.triangles.assign(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                             mesh.triangles.begin() + static_cast<std::ptrdiff_t>(end));
      const fs::path path = first == 0 ? dir.write("a.off", make_off(piece))
                                       : dir.write("a.ply", make_ply_of(piece, kPlyFormats.at(2)));
      options.first_id = static_cast<std::uint32_t>(first);
      stream_mesh(
          path, [&](MeshView part, std::uint32_t id) { rasterizer.draw(part, id); }, options);
      first = end;
    }
    rasterizer.resolve(streamed);
    CHECK(compare(whole, streamed).equal());
  }

  TEST_CASE("progress rises to 1, and can end the work") {
    const TempDir dir;
    const TriangleMesh& mesh = scene().mesh;
    for (const bool faces_first : {false, true}) {
      CAPTURE(faces_first);
      const fs::path path = dir.write("a.ply", make_ply_of(mesh, "ascii", faces_first));
      StreamOptions options = least_memory();
      std::vector<double> shares;
      std::vector<double> at_parts;
      options.progress = [&](double share) {
        shares.push_back(share);
        return true;
      };
      stream_mesh(
          path, [&](MeshView, std::uint32_t) { at_parts.push_back(shares.back()); }, options);
      CHECK(std::is_sorted(shares.begin(), shares.end()));
      CHECK(shares.size() > 10);
      CHECK(shares.front() < 0.1);
      CHECK(shares.back() == 1.0);
      CHECK(at_parts.back() - at_parts.front() > 0.2);

      int left = 5;
      options.progress = [&](double) { return --left > 0; };
      CHECK_THROWS_AS(stream_mesh(
                          path, [](MeshView, std::uint32_t) {}, options),
                      Cancelled);
      CHECK(left == 0);
      options.progress = [](double) -> bool { throw std::out_of_range("mine"); };
      CHECK_THROWS_AS(stream_mesh(
                          path, [](MeshView, std::uint32_t) {}, options),
                      std::out_of_range);
    }
  }

  TEST_CASE("what the callback throws comes out") {
    const TempDir dir;
    const fs::path path = dir.write("a.off", make_off(scene().mesh));
    CHECK_THROWS_AS(stream_mesh(path, [](MeshView, std::uint32_t) { throw std::out_of_range("mine"); }),
                    std::out_of_range);
  }

  TEST_CASE("a fault half way comes out after the parts before it") {
    const TempDir dir;
    std::string text = make_obj(scene().mesh);
    text += "f 1 2\n";
    std::size_t parts = 0;
    const std::string error = error_of([&] {
      stream_mesh(
          dir.write("a.obj", text), [&](MeshView, std::uint32_t) { ++parts; }, least_memory());
    });
    CHECK(contains(error, "a face needs 3 corners or more"));
    CHECK(contains(
        error, "line " + std::to_string(scene().mesh.positions.size() + scene().mesh.triangles.size() + 1)));
    CHECK(parts > 3);
  }

  TEST_CASE("a word of a text that is longer than any number is refused where it is") {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ";
    text.append(70000, '0').append("3\n");
    const TempDir dir;
    const fs::path path = dir.write("a.obj", text);
    CHECK(load_mesh(path).triangles.size() == 1);
    CHECK(contains(error_of([&] { stream_mesh(path, [](MeshView, std::uint32_t) {}); }),
                   "a.obj: line 4: expected a corner"));
    // Where it says nothing, it may be of any length.
    std::string longer = "# ";
    longer.append(300000, 'c').append("\ng ").append(300000, 'g').append("\\\n").append(70000, 'h');
    longer.append("\nv 0 0 0\nv 1 0 0\nv 0 1 0").append(300000, ' ').append("\nf 1 2 3\n");
    Joined joined;
    stream_mesh(
        dir.write("b.obj", longer), [&](MeshView part, std::uint32_t id) { joined.add(part, id); },
        least_memory());
    CHECK(joined.difference({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}) == "");
  }

  TEST_CASE("a polygon may be of more corners than memory holds") {
    constexpr std::uint32_t kCorners = 300000;
    TriangleMesh mesh;
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
    for (std::uint32_t i = 0; i < kCorners; ++i) {
      text.append(" ").append(std::to_string(i % 4 + 1));
      if (i >= 2) mesh.triangles.emplace_back(0u, (i - 1) % 4, i % 4);
    }
    const TempDir dir;
    const fs::path path = dir.write("a.obj", text + "\n");
    Joined joined;
    const MeshReport report = stream_mesh(
        path, [&](MeshView part, std::uint32_t id) { joined.add(part, id); }, least_memory());
    CHECK(joined.parts > 3);
    CHECK(report.faces == 1);
    CHECK(joined.difference(mesh) == "");
  }

  TEST_CASE("a file may be larger than 4 GiB") {
    const TempDir dir;
    const TriangleMesh mesh = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, {{2, 0, 1}}};
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement pad 2\nproperty list uint uchar bytes\n"
        "element vertex 3\n" +
        kVertexHeader + kFaceHeader + "end_header\n";
    const std::string ply = make_ply_of(mesh, kPlyFormats.at(1));
    const std::string body = ply.substr(ply.find("end_header\n") + 11);
    const fs::path path = dir.write("large.ply", header);
    constexpr std::uint32_t kPad = 0xfffffff0u;
    {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      std::uint64_t at = header.size();
      for (int i = 0; i < 2; ++i) {
        std::string count;
        put_binary(count, kPad, false);
        file.seekp(static_cast<std::streamoff>(at));
        file.write(count.data(), 4);
        at += 4 + std::uint64_t{kPad};  // a hole: nothing is stored
      }
      file.seekp(static_cast<std::streamoff>(at));
      file.write(body.data(), static_cast<std::streamsize>(body.size()));
      if (!file.flush()) {
        MESSAGE("skipped: no file of 8 GiB can be made here");
        return;
      }
    }
    Joined joined;
    stream_mesh(
        path, [&](MeshView part, std::uint32_t id) { joined.add(part, id); }, least_memory());
    CHECK(joined.difference(mesh) == "");
    fs::resize_file(path, fs::file_size(path) - 1);
    const std::string error = error_of([&] { stream_mesh(path, [](MeshView, std::uint32_t) {}); });
    CHECK(contains(error, "large.ply: face 0 (before byte "));
    CHECK(contains(error, "is cut short"));
  }

  TEST_CASE("options out of range are refused") {
    const TempDir dir;
    const fs::path path = dir.write("a.off", make_off(scene().mesh));
    StreamOptions options;
    options.memory_bytes = kLeast - 1;
    CHECK(contains(error_of([&] {
                     stream_mesh(
                         path, [](MeshView, std::uint32_t) {}, options);
                   }),
                   "memory_bytes is 1048575; it must be at least 1048576"));
  }

  TEST_CASE("the caller's floating-point mode changes nothing and is kept") {
    const TempDir dir;
    const fs::path path =
        dir.write("a.ply", make_ply(kPlyFormats.at(2),
                                    {{1e-40, 0.1, 1 + 0x1p-24}, {-1e-45, 16777217, 1e-310}, {0, 0, 0}},
                                    {{0, 1, 2}}, {"double", "uchar", "int"}));
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      const TriangleMesh mesh = load_mesh(path);
      Joined joined;
      hard::under_mode(mode.bits, [&] {
        stream_mesh(path, [&](MeshView part, std::uint32_t id) { joined.add(part, id); });
        return 0;
      });
      CHECK(joined.difference(mesh) == "");
    }
  }
}
