#include <png.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <doctest/doctest.h>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "tool/run_tool.h"

namespace fs = std::filesystem;
using plumb::test::run_tool;
using plumb::test::TempFolder;

namespace {

constexpr int kWidth = 48, kHeight = 27;
const std::string kScene = "teapot-in-stadium:2000";
const std::string kArguments = " builtin:" + kScene + " --size 48x27 --threads 1 ";

plumb::Frame library_frame() {
  const plumb::BuiltinScene scene = plumb::builtin_scene(kScene);
  plumb::Frame frame(kWidth, kHeight);
  plumb::cast(plumb::Bvh(scene.mesh), scene.camera(kWidth, kHeight), frame);
  return frame;
}

plumb::Frame read_exr(const fs::path& path) {
  Imf::InputFile file(path.c_str());
  const Imf::ChannelList& channels = file.header().channels();
  std::set<std::string> names;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) names.insert(channel.name());
  CHECK(names == std::set<std::string>{"Z", "id"});
  REQUIRE(channels.findChannel("Z") != nullptr);
  REQUIRE(channels.findChannel("id") != nullptr);
  CHECK(channels.findChannel("Z")->type == Imf::FLOAT);
  CHECK(channels.findChannel("id")->type == Imf::UINT);
  const Imath::Box2i window = file.header().dataWindow();
  REQUIRE(window.min == Imath::V2i(0, 0));
  REQUIRE(window.max == Imath::V2i(kWidth - 1, kHeight - 1));

  plumb::Frame frame(kWidth, kHeight);
  Imf::FrameBuffer buffer;
  buffer.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(frame.depth.data()), 4, 4 * kWidth));
  buffer.insert("id", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(frame.id.data()), 4, 4 * kWidth));
  file.setFrameBuffer(buffer);
  file.readPixels(0, kHeight - 1);
  return frame;
}

void check_png(const fs::path& path) {
  CAPTURE(path.string());
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&image, path.c_str()) != 0);
  CHECK(image.width == kWidth);
  CHECK(image.height == kHeight);
  png_image_free(&image);
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

}  // namespace

TEST_SUITE_BEGIN("tool: files");

TEST_CASE("render writes the library's frame, bit for bit, as Z (float) and id (uint)") {
  const TempFolder folder;
  const plumb::Frame expected = library_frame();
  REQUIRE(std::count(expected.id.begin(), expected.id.end(), plumb::kNone) > 0);
  for (const std::string method : {"bvh2", "bvh4", "bvh8", "raster"}) {
    CAPTURE(method);
    const fs::path file = folder / (method + ".exr");
    REQUIRE(run_tool("render" + kArguments + "--method " + method + " --out " + file.string()).status == 0);
    CHECK(plumb::compare(read_exr(file), expected).equal());
  }
}

TEST_CASE("compare writes a frame and two pictures for each method, and nothing else where they agree") {
  const TempFolder folder;
  const fs::path out = folder / "deep/er";
  fs::create_directories(out);
  // A picture of differences from an earlier comparison would contradict this one.
  std::ofstream(out / "bvh2-raster.diff.png") << "old";
  REQUIRE(run_tool("compare" + kArguments + "--methods bvh2,raster --out " + out.string()).status == 0);
  CHECK(names_in(out) == std::set<std::string>{"bvh2.exr", "bvh2.depth.png", "bvh2.id.png", "raster.exr",
                                               "raster.depth.png", "raster.id.png"});
  const plumb::Frame expected = library_frame();
  for (const std::string method : {"bvh2", "raster"}) {
    CHECK(plumb::compare(read_exr(out / (method + ".exr")), expected).equal());
    check_png(out / (method + ".depth.png"));
    check_png(out / (method + ".id.png"));
  }
}

TEST_CASE("compare makes the folder that --out names, with those above it") {
  const TempFolder folder;
  const fs::path out = folder / "not/yet/there";
  REQUIRE(run_tool("compare" + kArguments + "--methods bvh2 --out " + out.string()).status == 0);
  CHECK(names_in(out).size() == 3);
}

TEST_CASE("a mesh file is read, framed and rendered as the library does it") {
  const TempFolder folder;
  const fs::path mesh_file = folder / "two.obj";
  std::ofstream(mesh_file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\nf 1 2 3\nf 2 4 3\n";
  const fs::path out = folder / "two.exr";
  REQUIRE(
      run_tool("render --size 48x27 --method bvh8 --fov 30 --out " + out.string() + " " + mesh_file.string())
          .status == 0);
  const plumb::TriangleMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}}, {{0, 1, 2}, {1, 3, 2}}};
  plumb::Frame expected(kWidth, kHeight);
  plumb::cast(plumb::Bvh(mesh), plumb::frame_all(mesh, kWidth, kHeight, 30.0), expected);
  REQUIRE(std::count(expected.id.begin(), expected.id.end(), 1u) > 0);
  CHECK(plumb::compare(read_exr(out), expected).equal());
}

TEST_SUITE_END();
