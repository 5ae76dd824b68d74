// What is behind what a camera sees, which triangles it sees, and which points a light reaches.

#include <algorithm>
#include <cstddef>
#include <cstdio>

#include <plumb/plumb.h>

int main() {
  // A ground of two triangles, 0 and 1, and above it a pane of glass of two, 2 and 3.
  const plumb::TriangleMesh scene{
      {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}},
  };
  const plumb::Bvh bvh(scene);
  const plumb::Camera camera = plumb::Camera::look_at({0, 5, 0.5f}, {0, 0, 0}, {0, 1, 0}, 40, 64, 64);

  // The first two surfaces of every pixel: glass is blended over what layer 1 has behind it. By triangles the
  // layers are the same bits.
  plumb::LayeredFrame rays(64, 64, 2), triangles(64, 64, 2);
  plumb::cast_layers(bvh, camera, rays);
  plumb::rasterize_layers(scene, camera, triangles);
  const bool same = plumb::compare(rays.layer(0), triangles.layer(0)).equal() &&
                    plumb::compare(rays.layer(1), triangles.layer(1)).equal();
  const plumb::Frame behind = rays.layer(1);
  const auto through_glass =
      std::count_if(behind.id.begin(), behind.id.end(), [](auto id) { return id != plumb::kNone; });

  // What a renderer must load: the triangles that are seen at all, with their pixels.
  for (const plumb::VisibleTriangle& seen : plumb::visible_triangles(rays.layer(0)))
    std::printf("triangle %u in %llu pixels\n", static_cast<unsigned>(seen.id),
                static_cast<unsigned long long>(seen.pixels));

  // A lamp above, and its map. The map is sampled, any() is exact: they agree but near the shadow's edge.
  const glm::vec3 lamp{0, 4, 0};
  const plumb::ShadowMap map(bvh, plumb::Camera::look_at(lamp, {0, 0, 0}, {0, 0, 1}, 90, 256, 256));
  std::size_t points = 0, different = 0, dark = 0;
  for (int i = -24; i <= 24; ++i) {
    for (int j = -24; j <= 24; ++j) {
      plumb::Ray to_lamp;
      to_lamp.origin = {0.125f * static_cast<float>(i), 0, 0.125f * static_cast<float>(j)};
      to_lamp.direction = lamp - to_lamp.origin;
      to_lamp.tmax = 1;  // not beyond the lamp
      const bool lit = !bvh.any(to_lamp);
      ++points;
      dark += lit ? 0 : 1;
      different += map.lit(to_lamp.origin, 0.01f) == lit ? 0 : 1;
    }
  }
  std::printf("%zu of %zu points in the shadow; the map differs in %zu\n", dark, points, different);

  const bool right = same && through_glass > 0 && dark > 0 && different * 20 < points;
  std::printf("%s\n", right ? "as it should be" : "WRONG");
  return right ? 0 : 1;
}
