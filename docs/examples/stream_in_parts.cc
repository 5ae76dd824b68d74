// A scene drawn in parts, one in memory at a time, as it would be when it does not fit as a whole. Each
// part says which ids its triangles have in the whole scene; in which order the parts come does not matter.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <plumb/plumb.h>

namespace {

// The triangles [begin, end) of a mesh as a mesh of its own. A program would rather read them from a
// file or make them.
plumb::TriangleMesh part_of(const plumb::TriangleMesh& whole, std::size_t begin, std::size_t end) {
  plumb::TriangleMesh part;
  for (std::size_t i = begin; i < end; ++i) {
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    const glm::uvec3& corners = whole.triangles[i];
    part.positions.insert(part.positions.end(), {whole.positions[corners.x], whole.positions[corners.y],
                                                 whole.positions[corners.z]});
    part.triangles.emplace_back(first, first + 1, first + 2);
  }
  return part;
}

}  // namespace

int main() {
  const plumb::BuiltinScene scene = plumb::builtin_scene("terrain:100000");
  const plumb::Camera camera = scene.camera(640, 360);
  const std::size_t triangles = scene.mesh.triangles.size();

  // The last part first. Where two parts share an edge, each pixel along it belongs to one of them, as
  // long as both have the very same vertices there.
  constexpr std::size_t kPart = 7001;
  std::size_t parts = 0;
  plumb::Rasterizer rasterizer(camera);
  for (std::size_t end = triangles; end > 0; ++parts) {
    const std::size_t begin = (end - 1) / kPart * kPart;
    rasterizer.draw(part_of(scene.mesh, begin, end), static_cast<std::uint32_t>(begin));
    end = begin;
  }
  plumb::Frame streamed(camera.width, camera.height);
  rasterizer.resolve(streamed);

  plumb::Frame at_once(camera.width, camera.height);
  plumb::rasterize(scene.mesh, camera, at_once);

  const bool equal = plumb::compare(streamed, at_once).equal();
  const bool sees_both_ends =
      std::any_of(streamed.id.begin(), streamed.id.end(), [&](std::uint32_t id) { return id < kPart; }) &&
      std::any_of(streamed.id.begin(), streamed.id.end(),
                  [&](std::uint32_t id) { return id != plumb::kNone && id >= triangles - kPart; });
  std::printf("%zu triangles in %zu parts: %s\n", triangles, parts,
              equal ? "the same bits as in one piece" : "NOT what one piece shows");
  return equal && sees_both_ends ? 0 : 1;
}
