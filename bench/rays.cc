#include "rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/surface.h"

namespace plumb::bench {
namespace {

constexpr int kPacket = 4;  // pixels of a packet's side

// Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators" (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// Uniform from -1 to 1.
  double next() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

// A point of the unit sphere, by rejection from the cube: no library function whose last bit varies.
glm::dvec3 on_sphere(Random& random) {
  for (;;) {
    const double x = random.next(), y = random.next(), z = random.next();
    const double square = x * x + y * y + z * z;
    if (square > 1e-6 && square <= 1.0) return glm::dvec3(x, y, z) / std::sqrt(square);
  }
}

template <typename Answer>
void make_room(RaySet<Answer>& set) {
  set.expected = std::make_unique<Answer[]>(set.rays.size());
  set.answers = std::make_unique<Answer[]>(set.rays.size());
}

// Calls visit(x, y) for every pixel, block by block.
template <typename Visit>
void in_packets(const Camera& camera, const Visit& visit) {
  for (int y0 = 0; y0 < camera.height; y0 += kPacket) {
    for (int x0 = 0; x0 < camera.width; x0 += kPacket) {
      for (int y = y0; y < std::min(y0 + kPacket, camera.height); ++y) {
        for (int x = x0; x < std::min(x0 + kPacket, camera.width); ++x) visit(x, y);
      }
    }
  }
}

std::vector<Ray> camera_rays(const Camera& camera) {
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  in_packets(camera, [&](int x, int y) { rays.push_back(camera.ray(x, y)); });
  return rays;
}

// The median depth of what is seen; 1 where nothing is.
double median_depth(std::span<const Hit> hits) {
  std::vector<float> depths;
  for (const Hit& hit : hits) {
    if (hit.id != kNone) depths.push_back(hit.t);
  }
  if (depths.empty()) return 1.0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return double{*middle};
}

glm::dvec3 light_near_eye(const Camera& camera, std::span<const Hit> hits) {
  const glm::dvec3 right = glm::normalize(camera.du), up = -glm::normalize(camera.dv);
  return glm::dvec3(camera.eye) + 0.25 * median_depth(hits) * (right + up);
}

// The start of a ray that leaves the surface on the camera's side: off it by 64 units in the last
// place of the greatest coordinate, as renderers do.
struct Start {
  glm::dvec3 point, normal;
};

Start start_of(const View& view, const Ray& ray, const Hit& hit) {
  const Surface found = surface(view.mesh, ray, hit);
  const bool faces_away = glm::dot(found.normal, ray.direction) > 0.0f;
  const glm::dvec3 normal = faces_away ? -glm::dvec3(found.normal) : glm::dvec3(found.normal);
  const glm::dvec3 point(found.point);
  const double reach = std::max({std::fabs(point.x), std::fabs(point.y), std::fabs(point.z)});
  return {point + normal * (reach * 0x1p-18), normal};
}

void add_secondary_rays(Workload& workload) {
  const std::span<const Hit> hits = workload.camera.expected_span();
  const glm::dvec3 light = light_near_eye(workload.view.camera, hits);
  const auto reach = static_cast<float>(0.05 * median_depth(hits));
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].id == kNone) continue;
    const Start start = start_of(workload.view, workload.camera.rays[i], hits[i]);
    const glm::vec3 origin(start.point);
    // The light is at t = 1.
    workload.shadow.rays.push_back({origin, 0.0f, glm::vec3(light - start.point), 1.0f});
    // A point of the unit sphere that touches the surface from above: the cosine law.
    Random random(i);
    const glm::dvec3 direction = start.normal + on_sphere(random);
    workload.diffuse.rays.push_back(
        {origin, 0.0f, glm::vec3(glm::normalize(direction)), std::numeric_limits<float>::infinity()});
    const glm::dvec3 other = start.normal + on_sphere(random);
    workload.occlusion.rays.push_back({origin, 0.0f, glm::vec3(glm::normalize(other)), reach});
  }
}

std::vector<Ray> random_rays(MeshView mesh, std::size_t count) {
  glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi(-lo);
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (const std::uint32_t corner : {triangle.x, triangle.y, triangle.z}) {
      const glm::dvec3 p(mesh.positions[corner]);
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      lo = glm::min(lo, p);
      hi = glm::max(hi, p);
    }
  }
  std::vector<Ray> rays;
  if (!(lo.x <= hi.x)) return rays;
  Random random(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 share = 0.5 * (glm::dvec3(random.next(), random.next(), random.next()) + 1.0);
    const glm::dvec3 direction = on_sphere(random);
    rays.push_back({glm::vec3(lo + share * (hi - lo)), 0.0f, glm::vec3(direction),
                    std::numeric_limits<float>::infinity()});
  }
  return rays;
}

}  // namespace

std::size_t differences(const RaySet<Hit>& set) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.rays.size(); ++i) count += set.answers[i] == set.expected[i] ? 0 : 1;
  return count;
}

std::size_t differences(const RaySet<bool>& set) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.rays.size(); ++i) count += set.answers[i] == set.expected[i] ? 0 : 1;
  return count;
}

std::size_t other_triangles(const RaySet<Hit>& set) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.rays.size(); ++i) count += set.answers[i].id == set.expected[i].id ? 0 : 1;
  return count;
}

void spoil(RaySet<Hit>& set) {
  for (Hit& hit : set.answer_span()) hit = {-1.0f, kNone - 1};
}

void spoil(RaySet<bool>& set) {
  for (std::size_t i = 0; i < set.rays.size(); ++i) set.answers[i] = !set.expected[i];
}

std::unique_ptr<Workload> make_workload(View view) {
  BuildOptions options;
  options.width = 2;
  const Bvh reference(view.mesh, options);
  const Frame clear(view.camera.width, view.camera.height);
  auto workload = std::make_unique<Workload>(Workload{std::move(view), {}, {}, {}, {}, {}, clear, clear});
  cast(reference, workload->view.camera, workload->expected_frame);

  workload->camera.rays = camera_rays(workload->view.camera);
  make_room(workload->camera);
  reference.closest(workload->camera.rays, workload->camera.expected_span());
  add_secondary_rays(*workload);
  make_room(workload->shadow);
  make_room(workload->occlusion);
  make_room(workload->diffuse);
  workload->random.rays = random_rays(workload->view.mesh, workload->camera.rays.size() / 4);
  make_room(workload->random);
  reference.any(workload->shadow.rays, workload->shadow.expected_span());
  reference.any(workload->occlusion.rays, workload->occlusion.expected_span());
  reference.closest(workload->diffuse.rays, workload->diffuse.expected_span());
  reference.closest(workload->random.rays, workload->random.expected_span());
  return workload;
}

Frame frame_of_camera_rays(const Workload& workload) {
  const Camera& camera = workload.view.camera;
  Frame frame(camera.width, camera.height);
  std::size_t i = 0;
  in_packets(camera, [&](int x, int y) {
    const auto pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
    frame.depth[pixel] = workload.camera.answers[i].t;
    frame.id[pixel] = workload.camera.answers[i].id;
    ++i;
  });
  return frame;
}

}  // namespace plumb::bench
