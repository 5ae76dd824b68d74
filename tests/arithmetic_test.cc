#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/simd.h"
#include "support/closed_meshes.h"
#include "support/effort.h"
#include "support/hard_rays.h"
#include "support/print.h"
#include "support/random.h"

// The lesser arithmetics: what each promises, and that each can fail where it promises nothing.

using namespace plumb;
using hard::Random;

namespace {

Bvh tree_of(MeshView mesh, Arithmetic arithmetic, Simd simd = Simd::Auto) {
  BuildOptions options;
  options.arithmetic = arithmetic;
  options.simd = simd;
  return Bvh(mesh, options);
}

std::string name_of(Arithmetic arithmetic) {
  constexpr const char* kNames[] = {"fast", "watertight", "exact"};
  return kNames[static_cast<int>(arithmetic)];
}

constexpr Arithmetic kLesser[] = {Arithmetic::Fast, Arithmetic::Watertight};

// A point and a direction from it.
struct Aim {
  glm::vec3 from, direction;
};

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
double dot(const glm::dvec3& p, const glm::dvec3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// Whether the point is at least 1/8 away from every triangle's plane or box. Coordinates are below 2^13, and
// their rounding below 2^-10.
bool is_clear(const TriangleMesh& mesh, const glm::vec3& p) {
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = std::fmin(a[axis], std::fmin(b[axis], c[axis]));
      const float hi = std::fmax(a[axis], std::fmax(b[axis], c[axis]));
      apart = apart || p[axis] < lo - 0.125f || p[axis] > hi + 0.125f;
    }
    const glm::dvec3 n = cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const double off = dot(n, glm::dvec3(p) - glm::dvec3(a));
    if (!apart && !(off * off > dot(n, n) / 64.0)) return false;
  }
  return true;
}

// Rays from inside a closed mesh at its vertices, at the middles of its edges, and at places near there.
std::vector<Aim> aims_from_inside(const TriangleMesh& mesh, const Bvh& exact, int count, Random& random) {
  std::vector<Aim> aims;
  std::vector<Hit> hits;
  while (static_cast<int>(aims.size()) < count) {
    const glm::vec3 from = random.unit3() * (random.one_in(2) ? 4000.0f : 8.0f);
    exact.all({from, 0.0f, {0.37f, 0.51f, -0.77f}}, hits);
    if (hits.size() % 2 == 0 || !is_clear(mesh, from)) continue;
    for (int i = 0; i < 40; ++i) {
      const glm::uvec3& t = random.pick(mesh.triangles);
      const int k = static_cast<int>(random.below(3));
      const glm::vec3 a = mesh.positions[t[k]], b = mesh.positions[t[(k + 1) % 3]];
      const float along = static_cast<float>(random.below(3)) * 0.5f;
      glm::vec3 to = a + (b - a) * along;
      if (random.one_in(4)) to += random.unit3() * 0x1p-12f;
      aims.push_back({from, to - from});
    }
  }
  return aims;
}

// The mesh and the rays with every coordinate times a power of two, directions times another.
TriangleMesh scaled(TriangleMesh mesh, float scale) {
  for (glm::vec3& p : mesh.positions) p *= scale;
  return mesh;
}

std::size_t misses(const Bvh& bvh, const std::vector<Aim>& aims, float scale, float direction_scale) {
  std::size_t count = 0;
  for (const Aim& aim : aims) {
    const Ray ray{aim.from * scale, 0.0f, aim.direction * direction_scale};
    const bool closest = bvh.closest(ray).id != kNone;
    CHECK(bvh.any(ray) == closest);
    count += closest ? 0 : 1;
  }
  return count;
}

// What a tree answers to rays, by every query.
struct Answers {
  std::vector<Hit> closest;
  std::vector<bool> any;
  std::vector<std::vector<Hit>> all;
};

Answers answers_of(const Bvh& bvh, const std::vector<Ray>& rays) {
  Answers answers{std::vector<Hit>(rays.size()), {}, std::vector<std::vector<Hit>>(rays.size())};
  const auto any = std::make_unique<bool[]>(rays.size());
  bvh.closest(rays, answers.closest);
  bvh.any(rays, std::span<bool>(any.get(), rays.size()));
  answers.any.assign(any.get(), any.get() + rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) bvh.all(rays[i], answers.all[i]);
  return answers;
}

std::string message_of(const BuildOptions& options) {
  try {
    Bvh(TriangleMesh{}, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("arithmetic") {
  TEST_CASE("watertight: no ray leaves a closed surface unseen through an edge or a vertex; fast: some do") {
    std::size_t fast_misses = 0, rays = 0;
    for (const hard::ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      Random random(1);
      const Bvh exact = tree_of(closed.mesh, Arithmetic::Exact);
      const std::vector<Aim> aims = aims_from_inside(closed.mesh, exact, hard::effort(4000), random);
      CHECK(misses(exact, aims, 1.0f, 1.0f) == 0);
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        CHECK(misses(tree_of(closed.mesh, Arithmetic::Watertight, simd), aims, 1.0f, 1.0f) == 0);
      }
      fast_misses += misses(tree_of(closed.mesh, Arithmetic::Fast), aims, 1.0f, 1.0f);
      rays += aims.size();
    }
    MESSAGE("fast misses " << fast_misses << " of " << rays << " rays");
    CHECK(fast_misses > 0);
  }

  TEST_CASE("watertight: nor where coordinates and directions are very small or very large") {
    const std::vector<hard::ClosedMesh> meshes = hard::closed_meshes();
    for (const hard::ClosedMesh* closed : {&meshes[0], &meshes[5]}) {  // the cube, the torus
      CAPTURE(closed->name);
      Random random(2);
      const std::vector<Aim> aims = aims_from_inside(closed->mesh, tree_of(closed->mesh, Arithmetic::Exact),
                                                     hard::effort(1000), random);
      for (const int exponent : {-130, -100, -60, -30, 20, 27, 50, 100}) {
        CAPTURE(exponent);
        const float scale = std::ldexp(1.0f, exponent);
        const TriangleMesh mesh = scaled(closed->mesh, scale);
        for (const Simd simd : simd_targets()) {
          CAPTURE(simd_name(simd));
          const Bvh bvh = tree_of(mesh, Arithmetic::Watertight, simd);
          for (const int direction_exponent : {-75, -71, 0, 46, 60}) {
            CAPTURE(direction_exponent);
            // A t that rounds to zero or infinity is no hit.
            if (std::abs(exponent - direction_exponent) > 120) continue;
            CHECK(misses(bvh, aims, scale, std::ldexp(1.0f, direction_exponent)) == 0);
          }
        }
      }
    }
  }

  TEST_CASE("watertight: along the axes, through all edges and vertices of a cube") {
    const TriangleMesh cube = hard::closed_meshes().front().mesh;
    for (const Simd simd : simd_targets()) {
      CAPTURE(simd_name(simd));
      const Bvh bvh = tree_of(cube, Arithmetic::Watertight, simd);
      for (int axis = 0; axis < 3; ++axis) {
        for (int i = -960; i <= 960; i += 64) {
          for (int j = -960; j <= 960; j += 64) {
            for (const float sign : {1.0f, -1.0f}) {
              Ray ray{glm::vec3(0.0f), 0.0f, glm::vec3(sign * 0.0f)};
              ray.origin[(axis + 1) % 3] = static_cast<float>(i);
              ray.origin[(axis + 2) % 3] = static_cast<float>(j);
              ray.direction[axis] = sign * 1024.0f;
              CHECK(bvh.closest(ray).t == 1.0f);
            }
          }
        }
      }
    }
  }

  TEST_CASE("watertight: rays out of the range of its analysis are answered exactly") {
    for (const int exponent : {40, 60}) {
      for (hard::Case c : hard::make_cases(1, 24)) {
        c.mesh = scaled(c.mesh, std::ldexp(1.0f, exponent));
        for (Ray& ray : c.rays) {
          ray.origin *= std::ldexp(1.0f, exponent);
          if (std::fabs(ray.origin.x) < 0x1p40f) ray.origin.x = 0x1p40f;
        }
        const Answers exact = answers_of(tree_of(c.mesh, Arithmetic::Exact), c.rays);
        const Answers watertight = answers_of(tree_of(c.mesh, Arithmetic::Watertight), c.rays);
        CHECK(watertight.closest == exact.closest);
        CHECK(watertight.any == exact.any);
        CHECK(watertight.all == exact.all);
      }
    }
  }

  TEST_CASE("every target gives the same answers, right or wrong, to every query") {
    std::size_t hits = 0, wrong[2] = {0, 0};
    for (const hard::Case& c : hard::make_cases(hard::effort(std::uint64_t{12}), 24)) {
      const Answers exact = answers_of(tree_of(c.mesh, Arithmetic::Exact), c.rays);
      for (const Arithmetic arithmetic : kLesser) {
        CAPTURE(name_of(arithmetic));
        const Answers first = answers_of(tree_of(c.mesh, arithmetic), c.rays);
        for (const Simd simd : simd_targets()) {
          CAPTURE(simd_name(simd));
          const Answers answers = answers_of(tree_of(c.mesh, arithmetic, simd), c.rays);
          for (std::size_t i = 0; i < c.rays.size(); ++i) {
            INFO(c.describe(i));
            CHECK(answers.closest[i] == first.closest[i]);
            CHECK(answers.any[i] == first.any[i]);
            CHECK(answers.all[i] == first.all[i]);
          }
        }
        for (std::size_t i = 0; i < c.rays.size(); ++i) {
          INFO(c.describe(i));
          const std::vector<Hit>& all = first.all[i];
          CHECK((first.closest[i] == Hit{}) == all.empty());
          CHECK(first.any[i] == !all.empty());
          hits += all.size();
          wrong[static_cast<int>(arithmetic)] += first.closest[i] == exact.closest[i] ? 0 : 1;
        }
      }
    }
    MESSAGE("hits: " << hits << ", other answers than exact's: fast " << wrong[0] << ", watertight "
                     << wrong[1]);
    CHECK(hits > 1000);
    CHECK(wrong[0] > 50);
    CHECK(wrong[1] > 50);
  }

  TEST_CASE("easy rays see the same triangles in every arithmetic, but for one in a thousand") {
    for (const std::string name : {"spheres:20000", "terrain:20000", "soup:20000"}) {
      CAPTURE(name);
      const BuiltinScene scene = builtin_scene(name);
      const Camera camera = scene.camera(192, 108);
      Random random(3);
      std::vector<Ray> rays;
      for (int i = 0; i < hard::effort(20'000); ++i) {
        const int x = random.between(0, camera.width - 1), y = random.between(0, camera.height - 1);
        Ray ray = camera.ray(x, y);
        ray.direction += random.unit3() * 0.004f;
        rays.push_back(ray);
      }
      std::vector<Hit> exact(rays.size()), other(rays.size());
      tree_of(scene.mesh, Arithmetic::Exact).closest(rays, exact);
      for (const Arithmetic arithmetic : kLesser) {
        CAPTURE(name_of(arithmetic));
        tree_of(scene.mesh, arithmetic).closest(rays, other);
        std::size_t different = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          different += exact[i].id == other[i].id ? 0 : 1;
          if (exact[i].id == other[i].id && exact[i].id != kNone)
            CHECK(std::fabs(exact[i].t - other[i].t) <= 1e-3f * exact[i].t);
        }
        MESSAGE(name << ", " << name_of(arithmetic) << ": " << different << " of " << rays.size());
        CHECK(different <= rays.size() / 1000);
      }
    }
  }

  TEST_CASE("what is no ray sees nothing, and nothing sees nothing") {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const BuiltinScene scene = builtin_scene("spheres:5000");
    const Ray good = scene.camera(3, 3).ray(1, 1);
    std::vector<Ray> rays;
    for (const float bad : {kNan, kInf, -kInf}) {
      for (int axis = 0; axis < 3; ++axis) {
        rays.insert(rays.end(), 2, good);
        rays.rbegin()[0].origin[axis] = bad;
        rays.rbegin()[1].direction[axis] = bad;
      }
    }
    rays.insert(rays.end(), 4, good);
    rays.rbegin()[0].tmin = kNan;
    rays.rbegin()[1].tmax = kNan;
    rays.rbegin()[2].direction = glm::vec3(0.0f);
    rays.rbegin()[3].tmax = -1.0f;
    for (const Arithmetic arithmetic : kLesser) {
      for (const Simd simd : simd_targets()) {
        const Bvh bvh = tree_of(scene.mesh, arithmetic, simd);
        const Bvh empty = tree_of(TriangleMesh{}, arithmetic, simd);
        CHECK(empty.closest(good) == Hit{});
        for (const Ray& ray : rays) {
          std::vector<Hit> all{{1.0f, 1}};
          CHECK(bvh.closest(ray) == Hit{});
          CHECK(!bvh.any(ray));
          bvh.all(ray, all);
          CHECK(all.empty());
        }
      }
    }
  }

  TEST_CASE("limits on the ray and first_id count as in the exact arithmetic") {
    const TriangleMesh mesh{{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}, {-9, -9, 2}, {9, -9, 2}, {0, 9, 2}},
                            {{0, 1, 2}, {3, 4, 5}}};
    for (const Arithmetic arithmetic : kLesser) {
      BuildOptions options;
      options.arithmetic = arithmetic;
      options.first_id = 40;
      const Bvh bvh(mesh, options);
      const glm::vec3 o(0.0f), z(0.0f, 0.0f, 1.0f);
      CHECK(bvh.closest({o, 0.0f, z}) == Hit{1.0f, 40});
      CHECK(bvh.closest({o, 1.0f, z}) == Hit{2.0f, 41});
      CHECK(bvh.closest({o, 1.0f, z, 2.0f}) == Hit{2.0f, 41});
      CHECK(bvh.closest({o, 1.0f, z, 1.5f}) == Hit{});
      CHECK(bvh.closest({o, 0.0f, -z}) == Hit{});
      CHECK(!bvh.any({o, 2.0f, z}));
    }
  }

  TEST_CASE("a frame is cast in the tree's arithmetic") {
    const BuiltinScene scene = builtin_scene("teapot-in-stadium");
    const Camera camera = scene.camera(64, 36);
    for (const Arithmetic arithmetic : kLesser) {
      const Bvh bvh = tree_of(scene.mesh, arithmetic);
      Frame frame(64, 36);
      cast(bvh, camera, frame);
      for (int y = 0; y < 36; ++y) {
        for (int x = 0; x < 64; ++x) {
          const auto pixel = static_cast<std::size_t>(y * 64 + x);
          CHECK(Hit{frame.depth[pixel], frame.id[pixel]} == bvh.closest(camera.ray(x, y)));
        }
      }
    }
  }

  TEST_CASE("options that do not go together, or are none, are errors that say so") {
    for (const Arithmetic arithmetic : kLesser) {
      for (const int width : {2, 4}) {
        BuildOptions options;
        options.arithmetic = arithmetic;
        options.width = width;
        CHECK(message_of(options) ==
              "plumb: BuildOptions::width is " + std::to_string(width) +
                  "; for Arithmetic::Fast and Arithmetic::Watertight it must be 0 or 8");
      }
    }
    BuildOptions options;
    options.arithmetic = static_cast<Arithmetic>(3);
    CHECK(message_of(options) == "plumb: BuildOptions::arithmetic is 3, which is none of its enumerators");
    options = {};
    options.quality = static_cast<Quality>(-1);
    CHECK(message_of(options) == "plumb: BuildOptions::quality is -1, which is none of its enumerators");
    options = {};
    options.width = 16;
    CHECK(message_of(options) == "plumb: BuildOptions::width is 16; it must be 0, 2, 4 or 8");
  }
}
