// One picture made in two ways that share no code but the arithmetic at the bottom: by casting a ray
// through every pixel, and by drawing every triangle. They agree in every bit.

#include <cstdio>

#include <plumb/plumb.h>

int main() {
  constexpr int kWidth = 640;
  constexpr int kHeight = 360;

  // A scene that the library makes itself. For a file: link plumb::io, call plumb::load_mesh(path) and
  // plumb::frame_all(mesh, width, height).
  const plumb::BuiltinScene scene = plumb::builtin_scene("teapot-in-stadium:20000");
  const plumb::Camera camera = scene.camera(kWidth, kHeight);

  plumb::Frame by_rays(kWidth, kHeight);
  plumb::cast(plumb::Bvh(scene.mesh), camera, by_rays, {.method = plumb::CastMethod::Rays});

  plumb::Frame by_triangles(kWidth, kHeight);
  plumb::rasterize(scene.mesh, camera, by_triangles);

  const plumb::Comparison comparison = plumb::compare(by_rays, by_triangles);
  std::size_t seen = 0;
  for (const std::uint32_t id : by_rays.id) seen += id != plumb::kNone ? 1 : 0;
  std::printf("%zu of %zu pixels see a triangle, %zu ids and %zu depths differ\n", seen, comparison.pixels,
              comparison.different_ids, comparison.different_depths);
  for (const plumb::PixelDifference& place : comparison.first) {
    std::printf("pixel (%d, %d): t %.9g, triangle %u by rays; t %.9g, triangle %u by triangles\n", place.x,
                place.y, static_cast<double>(place.depth_a), static_cast<unsigned>(place.id_a),
                static_cast<double>(place.depth_b), static_cast<unsigned>(place.id_b));
  }
  return comparison.equal() && seen > 0 ? 0 : 1;
}
