#include <cmath>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Fractal value noise over an integer lattice: every octave interpolates hashed heights with Perlin's quintic
// ("Improving Noise", SIGGRAPH 2002). The land does not depend on how finely it is sampled.

namespace plumb::detail {
namespace {

constexpr double kExtent = 4096.0;  // metres, of each side
constexpr int kOctaves = 9;

// 0 to 1.
double lattice_value(std::int64_t x, std::int64_t z, int octave) {
  return hash_unit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(z),
                   static_cast<std::uint32_t>(octave));
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

double value_noise(double x, double z, int octave) {
  const double cell_x = std::floor(x), cell_z = std::floor(z);
  const std::int64_t ix = static_cast<std::int64_t>(cell_x), iz = static_cast<std::int64_t>(cell_z);
  const double u = fade(x - cell_x), v = fade(z - cell_z);
  const double near_side = lattice_value(ix, iz, octave) * (1.0 - u) + lattice_value(ix + 1, iz, octave) * u;
  const double far_side =
      lattice_value(ix, iz + 1, octave) * (1.0 - u) + lattice_value(ix + 1, iz + 1, octave) * u;
  return near_side * (1.0 - v) + far_side * v;
}

// Metres. The first octaves are ridges, the others detail that grows with the height. Their lattices are
// turned against each other, each by the angle whose cosine is 0.8, lest their axes show.
double height(double x, double z) {
  double px = x / 1500.0 + 17.0, pz = z / 1500.0 + 9.0;
  double amplitude = 1.0, sum = 0.0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    const double noise = 2.0 * value_noise(px, pz, octave) - 1.0;
    const double magnitude = noise < 0.0 ? -noise : noise;
    sum += octave < 3 ? amplitude * (1.0 - magnitude) : amplitude * noise * (0.3 + 0.5 * sum);
    amplitude *= 0.48;
    const double turned_x = 0.8 * px - 0.6 * pz;
    pz = 2.0 * (0.6 * px + 0.8 * pz);
    px = 2.0 * turned_x;
  }
  return 300.0 * sum * sum;
}

}  // namespace

BuiltinScene terrain(std::size_t size) {
  const double side = std::floor(std::sqrt(static_cast<double>(size) / 2.0) + 0.5);
  const std::uint32_t n = side < 1.0 ? 1u : static_cast<std::uint32_t>(side);
  BuiltinScene scene{{}, {}, {}, {0.0f, 1.0f, 0.0f}, 50.0};
  TriangleMesh& mesh = scene.mesh;
  mesh.positions.reserve((std::size_t{n} + 1) * (std::size_t{n} + 1));
  mesh.triangles.reserve(2 * std::size_t{n} * n);
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = kExtent * (static_cast<double>(j) / n - 0.5);
      const double z = kExtent * (static_cast<double>(i) / n - 0.5);
      append_vertex(mesh, {x, height(x, z), z});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j;
      append_quad(mesh, a, a + n + 1, a + n + 2, a + 1);
    }
  }
  scene.eye = {0.0f, 900.0f, 2000.0f};
  scene.target = {0.0f, 330.0f, 0.0f};
  return scene;
}

}  // namespace plumb::detail
