#include <algorithm>
#include <exception>
#include <memory>

#include "fuzz/targets.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "plumb/error.h"
#include "stream_check.h"

namespace plumb::fuzz {
namespace {

auto reader_of(std::string_view extension) {
  return extension == ".ply"   ? detail::read_ply
         : extension == ".obj" ? detail::read_obj
         : extension == ".stl" ? detail::read_stl
                               : detail::read_off;
}

std::string fault_of(const TriangleMesh& mesh, const MeshReport& report) {
  for (const glm::uvec3& t : mesh.triangles) {
    if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) return "an index is out of range";
  }
  if (report.vertices != mesh.positions.size()) return "the report has another number of vertices";
  if (report.triangles != mesh.triangles.size()) return "the report has another number of triangles";
  if (report.faces > report.triangles) return "the report has more faces than triangles";
  return "";
}

}  // namespace

std::string fault_of_reader(std::string_view extension, std::string_view bytes, bool* loaded) {
  if (loaded != nullptr) *loaded = false;
  // A copy that ends where the bytes end, so that a sanitizer sees one byte too many.
  const auto copy = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), copy.get());
  const std::string_view exact(copy.get(), bytes.size());
  const std::string file = std::string("mesh").append(extension);
  try {
    const test::Outcome whole = test::outcome_of([&](test::Outcome& outcome) {
      outcome.mesh = reader_of(extension)(exact, file, outcome.report, {});
    });
    if (!whole.error.empty() && !whole.error.starts_with(file + ": ")) {
      return "the error does not begin with the file: " + whole.error;
    }
    if (loaded != nullptr) *loaded = whole.error.empty();
    std::string fault = whole.error.empty() ? fault_of(whole.mesh, whole.report) : "";
    if (!fault.empty()) return fault;
    const std::string streamed =
        test::stream_difference(file, exact, {}, whole, test::smallest_sizes(exact, 2, 4096));
    return streamed.empty() ? "" : "streamed: " + streamed;
  } catch (const std::exception& error) {
    return std::string("an exception that is no plumb::Error: ") + error.what();
  }
}

}  // namespace plumb::fuzz
