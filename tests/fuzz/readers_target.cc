#include <algorithm>
#include <exception>
#include <memory>

#include "fuzz/targets.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "plumb/error.h"

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
  const std::string file = std::string("mesh").append(extension);
  try {
    MeshReport report;
    const TriangleMesh mesh = reader_of(extension)({copy.get(), bytes.size()}, file, report, {});
    if (loaded != nullptr) *loaded = true;
    return fault_of(mesh, report);
  } catch (const Error& error) {
    const std::string message = error.what();
    return message.starts_with(file + ": ") ? "" : "the error does not begin with the file: " + message;
  } catch (const std::exception& error) {
    return std::string("an exception that is no plumb::Error: ") + error.what();
  }
}

}  // namespace plumb::fuzz
