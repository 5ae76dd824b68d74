#include "help.h"

#include <cstddef>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "method.h"
#include "plumb/builtin.h"
#include "plumb/simd.h"

namespace plumb::tool {
namespace {

constexpr std::size_t kLineLength = 100;

/// Lines of at most kLineLength, but for longer words; those after the first begin with the indent.
std::string wrap(const std::string& text, const std::string& indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    if (length != 0 && length + 1 + word.size() > kLineLength) {
      result += "\n" + indent;
      length = indent.size();
    } else if (length != 0) {
      result += " ";
      ++length;
    }
    result += word;
    length += word.size();
  }
  return result;
}

std::string scenes_help() {
  std::string text = "Built-in scenes, as builtin:NAME[:SIZE]:\n";
  for (const BuiltinInfo& scene : builtin_scenes()) {
    fmt::format_to(
        std::back_inserter(text), "  {}\n      {}\n", wrap(scene.name + ": " + scene.description, "      "),
        wrap(fmt::format("SIZE: {}; {} unless said", scene.size_meaning, scene.default_size), "      "));
  }
  return text;
}

std::string methods_help() {
  std::string text = "Methods:\n";
  for (const MethodInfo& info : all_methods()) {
    fmt::format_to(std::back_inserter(text), "  {:<8}{}\n", info.name, info.description);
  }
  text += "Instruction sets of this machine, best first (the scalar methods have none):\n ";
  for (const Simd simd : simd_targets()) text.append(" ").append(simd_name(simd));
  return text + "\n";
}

constexpr std::string_view kFilesHelp =
    R"(Mesh files are told by their extension, in any case: .ply and .stl (text or binary), .obj and .off.
Every triangle keeps its place in the file: that is its id.
)";

constexpr std::string_view kCameraHelp =
    R"(The camera is the built-in scene's own, or frames all of a file's mesh; each of --eye, --target, --up
and --fov that is given replaces that part of it. X,Y,Z are decimal numbers, each rounded once to the
nearest float.
)";

}  // namespace

std::string main_help() {
  return R"(Examples:
  plumb compare                             rays and rasterizer on the built-in scene
  plumb compare mesh.ply --out pictures     the same on a mesh, with pictures of what is seen
  plumb render mesh.obj --method bvh8 --out frame.exr
  plumb info mesh.stl                       is it closed, manifold, oriented?
  plumb soak --seconds 600                  search for a wrong answer

"plumb SUBCOMMAND --help" lists its options. Messages go to standard error, results to standard output.

Exit status: 0 all is as it should be, 1 an answer differs, 2 bad usage or input.
)";
}

std::string compare_help() {
  return fmt::format(
      R"(Every method answers one question for each pixel: which triangle does its ray meet first, and at
which depth? Each frame is compared with the first method's, its ids and the bits of its depths.

Examples:
  plumb compare
  plumb compare mesh.ply --size 1920x1080 --simd all --out pictures
  plumb compare builtin:terrain:2000000 --methods bvh8,raster --json
  plumb compare mesh.obj --eye 3,2,5 --target 0,1,0 --fov 60

{}
{}
{}
{}
--layers K compares what lies behind too: the first K surfaces that each pixel's ray meets, in (t, id) order;
their files are METHOD.layer2.exr and so on. The methods tile and auto make none.

--out writes METHOD.exr (channels Z, float, and id, uint), METHOD.depth.png and METHOD.id.png, and
A-B.diff.png where two differ; with several instruction sets METHOD is METHOD-NAME.

Exit status: 0 the methods agree in every pixel, 1 they do not, 2 bad usage or input.
)",
      scenes_help(), kFilesHelp, methods_help(), kCameraHelp);
}

std::string render_help() {
  return fmt::format(
      R"(FILE.exr has the channels Z (float: the depth, +inf where nothing is seen) and id (uint: the triangle,
4294967295 where nothing is seen), compressed without loss. FILE.csv has a line "id,pixels" and then one for
each triangle that the frame shows, by ascending id.

--stream draws scenes that are larger than memory, with the same bits: the SCENEs are mesh files, in any
order of their triangles, read in parts that are drawn as they come; ids go on from file to file. Reading
holds at most --memory MIB, drawing up to 100 more, and 8 bytes a pixel, 16 at the end. Texts also put 12
bytes for each vertex on the disk, in the folder for temporary files (TMPDIR). Without both --eye and
--target the files are read twice, first for the box that the camera frames.

Examples:
  plumb render mesh.ply --method raster --out frame.exr
  plumb render --stream city-1.ply city-2.ply --eye 0,90,300 --target 0,0,0 --out city.exr
  plumb render builtin:grass --size 640x360 --method bvh4 --simd avx2 --out grass.exr

{}
{}
{}
{}
Exit status: 0 the frame is written, 2 bad usage or input.
)",
      scenes_help(), kFilesHelp, methods_help(), kCameraHelp);
}

std::string info_help() {
  return fmt::format(
      R"(The result, a table or with --json an object, goes to standard output.

Mesh: what is odd about its triangles. One is non-finite when a coordinate is NaN or infinite (it is
never seen), degenerate when its area is zero, exactly, and a duplicate when an earlier one has the
same three positions in any order.

Surface: the triangles with three different finite positions. Vertices at equal positions count as
one, for STL and many other files have three of its own for each triangle; -0 equals 0, and nothing is
equal that is only near. It is closed where every edge belongs to an even number of triangles, manifold
where it is a disk or half a disk about every point, oriented where neighbours agree which side is the
front. Half-edges, OpenMesh's for one, cannot hold triangles at an edge of three or more, or of two
that disagree, as they are: the first of these are listed.

Trees: inner nodes and leaves; nodes on the longest path; how full nodes and leaves are; the boxes and
triangles that a random line is expected to be tested against; memory held, in bytes for each triangle
of the mesh; triangles left out because they are never seen; the time that the build took.

Examples:
  plumb info mesh.stl
  plumb info builtin:spheres --width 8 --json

{}
{}
Exit status: 0 whatever the mesh is like, 2 bad usage or input.
)",
      scenes_help(), kFilesHelp);
}

std::string soak_help() {
  return R"(Every method on every instruction set is asked for closest, any and all hits, one by one and in spans,
and for frames, and compared with rational arithmetic. A difference is shrunk to a smallest case, which
is printed on standard output as a C++ test to paste. Ctrl-C ends the search early, with its report.

Examples:
  plumb soak --seconds 3600 --seed 7
  plumb soak --seconds 10 --threads 1 --json

Exit status: 0 no answer differs from the exact one, 1 one does, 2 bad usage.
)";
}

}  // namespace plumb::tool
