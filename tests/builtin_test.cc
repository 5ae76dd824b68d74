#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "base/fp_mode.h"
#include "plumb/builtin.h"
#include "plumb/error.h"
#include "scene/mesh_builder.h"
#include "scene/teapot.h"
#include "scene/track.h"

using namespace plumb;

namespace {

// 64-bit FNV-1a over 32-bit words.
class Hash {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 1099511628211u; }
  void add(float f) { add(std::bit_cast<std::uint32_t>(f)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

std::uint64_t hash_of(const BuiltinScene& scene) {
  Hash hash;
  for (const glm::vec3& p : scene.mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) hash.add(p[axis]);
  }
  for (const glm::uvec3& t : scene.mesh.triangles) {
    for (int k = 0; k < 3; ++k) hash.add(t[k]);
  }
  for (const glm::vec3* v : {&scene.eye, &scene.target, &scene.up}) {
    for (int axis = 0; axis < 3; ++axis) hash.add((*v)[axis]);
  }
  return hash.value();
}

std::string message_of(const std::string& name) {
  try {
    builtin_scene(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Edges between vertices that are equal in value, as directed pairs with how often they occur.
using Edge = std::pair<int, int>;
std::map<Edge, int> welded_edges(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, int> vertices;
  const auto vertex = [&](std::uint32_t index) {
    const glm::vec3& p = mesh.positions[index];
    return vertices.try_emplace({p.x, p.y, p.z}, static_cast<int>(vertices.size())).first->second;
  };
  std::map<Edge, int> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    const int a = vertex(t.x), b = vertex(t.y), c = vertex(t.z);
    ++edges[{a, b}];
    ++edges[{b, c}];
    ++edges[{c, a}];
  }
  return edges;
}

TriangleMesh teapot(int segments) {
  TriangleMesh mesh;
  detail::append_teapot(mesh, segments, {0.0, 0.0, 0.0}, 1.0);
  return mesh;
}

}  // namespace

TEST_SUITE("built-in scenes") {
  TEST_CASE("every scene is the same bits everywhere, by default and at another size") {
    CHECK(hash_of(builtin_scene("teapot-in-stadium")) == 0xcb8543b36ef19215u);
    CHECK(hash_of(builtin_scene("teapot-in-stadium:7000")) == 0xffacdc7524b2af81u);
    CHECK(hash_of(builtin_scene("terrain")) == 0xa73f3667e30a25e2u);
    CHECK(hash_of(builtin_scene("terrain:5000")) == 0x56f7d5d345e418c2u);
    CHECK(hash_of(builtin_scene("grid")) == 0xd3f8ad77d9b6255fu);
    CHECK(hash_of(builtin_scene("grid:45")) == 0x09bbb24540f93a7fu);
  }

#if defined(__SSE2__)
  TEST_CASE("the caller's floating-point mode changes no bit") {
    for (const char* name : {"teapot-in-stadium:7000", "terrain:5000", "grid:45"}) {
      const std::uint64_t expected = hash_of(builtin_scene(name));
      const detail::FpMode saved = detail::fp_mode();
      detail::set_fp_mode(saved | 0xe040u);  // FTZ, DAZ, toward zero
      const std::uint64_t hash = hash_of(builtin_scene(name));
      detail::set_fp_mode(saved);
      CHECK(hash == expected);
    }
  }
#endif

  TEST_CASE("every scene is sound: indices in range, coordinates finite, a camera") {
    for (const BuiltinInfo& info : builtin_scenes()) {
      CAPTURE(info.name);
      const BuiltinScene scene = builtin_scene(info.name);
      REQUIRE_FALSE(scene.mesh.triangles.empty());
      const bool finite = std::all_of(scene.mesh.positions.begin(), scene.mesh.positions.end(), is_finite);
      CHECK(finite);
      std::vector<bool> used(scene.mesh.positions.size(), false);
      for (const glm::uvec3& t : scene.mesh.triangles) {
        for (int k = 0; k < 3; ++k) used.at(t[k]) = true;
      }
      const auto unused = std::count(used.begin(), used.end(), false);
      CHECK(unused <= static_cast<std::ptrdiff_t>(used.size() / 100));
      CHECK(scene.camera(1280, 720).width == 1280);
      CHECK(info.description.find('\n') == std::string::npos);
      CHECK(hash_of(scene) == hash_of(builtin_scene(info.name + ":" + std::to_string(info.default_size))));
    }
  }

  TEST_CASE("a size in triangles is met within a fifth") {
    for (const std::size_t size : {2'000u, 10'000u, 50'000u, 320'000u, 1'000'000u}) {
      for (const char* name : {"teapot-in-stadium:", "terrain:"}) {
        CAPTURE(name);
        CAPTURE(size);
        const double triangles =
            static_cast<double>(builtin_scene(name + std::to_string(size)).mesh.triangles.size());
        CHECK(triangles > 0.8 * static_cast<double>(size));
        CHECK(triangles < 1.2 * static_cast<double>(size));
      }
    }
    CHECK(builtin_scene("terrain:2").mesh.triangles.size() == 2);
    CHECK(builtin_scene("terrain").mesh.triangles.size() == 500'000);
  }

  TEST_CASE("the grid has at least two triangles a block") {
    CHECK(builtin_scene("grid:1").mesh.triangles.size() >= 4);
    CHECK(builtin_scene("grid:64").mesh.triangles.size() >= 2 * (64 * 18 + 45 * 12));
  }

  TEST_CASE("an unknown name is an error that lists the known ones") {
    const std::string message = message_of("teapot");
    for (const BuiltinInfo& info : builtin_scenes()) CHECK(contains(message, info.name));
    CHECK(contains(message, "'teapot'"));
    CHECK(contains(message_of(""), "''"));
    CHECK(contains(message_of(":5"), "''"));
    CHECK(contains(message_of("Grid"), "'Grid'"));
  }

  TEST_CASE("a size that is no number or out of range is an error that names the range") {
    for (const char* size : {"", "x", "-5", "+5", " 5", "5 ", "5.5", "1e3", "0", "0x10", "4097", "5:5",
                             "99999999999999999999999999"}) {
      CAPTURE(size);
      CHECK(contains(message_of(std::string("grid:") + size), "from 1 to 4096"));
    }
    CHECK(contains(message_of("terrain:1"), "from 2 to 50000000"));
    CHECK(contains(message_of("terrain:50000001"), "from 2 to 50000000"));
    CHECK(contains(message_of("teapot-in-stadium:1999"), "from 2000 to 10000000"));
    CHECK(message_of("grid:1") == "no error");
    CHECK(message_of("teapot-in-stadium:2000") == "no error");
  }
}

TEST_SUITE("teapot") {
  TEST_CASE("the control points are the published ones") {
    // The literal is the hash of the 32 published patches, their indices looked up in the list of 306
    // points, computed apart from this code.
    const std::vector<detail::TeapotPatch> patches = detail::teapot_patches();
    REQUIRE(patches.size() == 32);
    std::uint64_t hash = 14695981039346656037u;
    std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> points;
    for (const detail::TeapotPatch& patch : patches) {
      for (const detail::TeapotPoint& p : patch) {
        points.insert({p.x, p.y, p.z});
        for (const std::int64_t c : {p.x, p.y, p.z})
          hash = (hash ^ static_cast<std::uint64_t>(c)) * 1099511628211u;
      }
    }
    CHECK(hash == 0xe676a227b667a899u);
    // Of the 306 four belong to no patch, and the 12 of the foot's edge are listed twice.
    CHECK(points.size() == 306 - 4 - 12);
  }

  TEST_CASE("patches meet without cracks: the only open edges are the published surface's own") {
    // The body is open at the rim (4 patches around) and the lid at its lower edge (4); handle and spout are
    // tubes (2 patches around) with two open ends each. With n = 1 the tubes would be flat.
    for (const int n : {2, 3, 7, 16}) {
      CAPTURE(n);
      const std::map<Edge, int> edges = welded_edges(teapot(n));
      int open = 0, repeated = 0;
      for (const auto& [edge, count] : edges) {
        repeated += count > 1 ? 1 : 0;
        open += edges.contains({edge.second, edge.first}) ? 0 : 1;
      }
      CHECK(repeated == 0);  // the triangles of neighbours run the same way around
      CHECK(open == (4 + 4 + 2 * 2 + 2 * 2) * n);
    }
  }

  TEST_CASE("no triangle is collapsed, and the poles' quads are triangles") {
    for (const int n : {1, 2, 9, 24}) {
      const TriangleMesh mesh = teapot(n);
      CHECK(mesh.triangles.size() == static_cast<std::size_t>(64 * n * n - 8 * n));
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
        REQUIRE(a != b);
        REQUIRE(b != c);
        REQUIRE(c != a);
      }
    }
  }

  TEST_CASE("the teapot stands on its foot and has its known extent") {
    TriangleMesh mesh;
    detail::append_teapot(mesh, 32, {10.0, 20.0, 30.0}, 2.0);
    glm::vec3 lo = mesh.positions[0], hi = lo;
    for (const glm::vec3& p : mesh.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    CHECK(lo.y == 20.0f);  // the bottom is flat
    CHECK(hi.y == 26.3f);  // the knob's top, 3.15 high
    CHECK(lo.x == 6.0f);   // the body's greatest radius is 2
    CHECK(hi.x == 14.0f);
    CHECK(lo.z == 24.0f);  // the handle reaches back to 3
    CHECK(hi.z > 36.8f);   // and the spout forward to 3.434
    CHECK(hi.z < 36.9f);
  }

  TEST_CASE("the finest teapot does not overflow") {
    const TriangleMesh mesh = teapot(detail::kMaxTeapotSegments);
    float greatest = 0.0f;
    for (const glm::vec3& p : mesh.positions) {
      greatest = std::max({greatest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    CHECK(greatest < 3.5f);
    CHECK_THROWS_AS(teapot(detail::kMaxTeapotSegments + 1), Error);
    CHECK_THROWS_AS(teapot(0), Error);
  }
}

TEST_SUITE("teapot-in-stadium") {
  TEST_CASE("the stadium is about a thousand times as long as the teapot") {
    const BuiltinScene scene = builtin_scene("teapot-in-stadium");
    float stadium = 0.0f;
    for (const glm::vec3& p : scene.mesh.positions) stadium = std::max(stadium, std::fabs(p.x));
    // The teapot is about 6.43 * 0.0375 long, as appended last.
    const glm::vec3& last = scene.mesh.positions.back();
    CHECK(std::fabs(last.x) < 0.25f);
    const float ratio = 2.0f * stadium / (6.43f * 0.0375f);
    CHECK(ratio > 900.0f);
    CHECK(ratio < 1200.0f);
  }

  TEST_CASE("painted lines, stripes and ground lie in one plane, lines first") {
    // What is seen where they overlap is the lower id, by the definition's rule.
    const TriangleMesh mesh = builtin_scene("teapot-in-stadium").mesh;
    std::size_t painted = 0;
    while (painted < mesh.triangles.size()) {
      const glm::uvec3& t = mesh.triangles[painted];
      if (mesh.positions[t.x].y != 0.0f || mesh.positions[t.y].y != 0.0f || mesh.positions[t.z].y != 0.0f)
        break;
      ++painted;
    }
    CHECK(painted > 1000);
  }
}

TEST_SUITE("grid") {
  // Where a ray is, along one axis, k * 2^17 below the eye.
  std::int64_t grid_place(int k, float component) {
    const double exact = k * 0x1p17 * double{component};
    REQUIRE(exact == std::floor(exact));
    return static_cast<std::int64_t>(exact);
  }

  TEST_CASE("coordinates are integers") {
    for (const glm::vec3& p : builtin_scene("grid:100").mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) REQUIRE(p[axis] == std::floor(p[axis]));
    }
  }

  TEST_CASE("pixel directions are exact dyadic fractions at the frame heights it is made for") {
    const BuiltinScene scene = builtin_scene("grid:8");
    for (const int height : {45, 90, 135, 180, 270, 360, 720, 1080, 2160, 256, 512, 1024}) {
      CAPTURE(height);
      const int width = height * 16 / 9;
      const Camera camera = scene.camera(width, height);
      int inexact = 0;
      for (int y = 0; y < height; y += 7) {
        for (int x = 0; x < width; x += 5) {
          const glm::vec3 d = camera.ray(x, y).direction;
          // Products of small integers: exact in double.
          const double scale = 256.0 * height;
          const bool exact = double{d.x} * scale == 135.0 * (2 * x + 1 - width) &&
                             double{d.y} * scale == 135.0 * (height - 1 - 2 * y) && d.z == -1.0f;
          inexact += exact ? 0 : 1;
        }
      }
      CHECK(inexact == 0);
    }
  }

  TEST_CASE("rays of a 720-line frame meet lines and diagonals of the upper half's tops as often as told") {
    // At k below the eye in units of 2^17, a ray is at k * 2^17 * direction, exactly; the blocks' sides are
    // 6048.
    const Camera camera = builtin_scene("grid:8").camera(1280, 720);
    for (const auto& told : {std::pair{9, 7}, std::pair{7, 9}, std::pair{6, 21}}) {
      const int k = told.first;
      std::size_t columns = 0, diagonals = 0;
      for (int x = 0; x < 1280; ++x) {
        const glm::vec3 direction = camera.ray(x, 0).direction;
        columns += grid_place(k, direction.x) % 6048 == 0 ? 1 : 0;
        diagonals += (grid_place(k, direction.x) - grid_place(k, direction.y)) % 6048 == 0 ? 1 : 0;
      }
      const std::size_t expected = static_cast<std::size_t>(1280 / told.second);
      CAPTURE(k);
      CHECK(columns >= expected);
      CHECK(columns <= expected + 1);
      CHECK(diagonals >= expected);
      CHECK(diagonals <= expected + 1);
    }
  }
}

TEST_SUITE("scene building") {
  TEST_CASE("turn gives cosine and sine of any share of a turn") {
    for (int i = -2000; i <= 2000; ++i) {
      const double share = i / 720.0;
      const detail::Turn turn = detail::turn(share);
      const double angle = 2.0 * std::numbers::pi * share;
      CHECK(turn.cos == doctest::Approx(std::cos(angle)).epsilon(1e-13).scale(1.0));
      CHECK(turn.sin == doctest::Approx(std::sin(angle)).epsilon(1e-13).scale(1.0));
    }
    CHECK(detail::turn(0.0).cos == 1.0);
    CHECK(detail::turn(0.25).cos == 0.0);
    CHECK(detail::turn(0.25).sin == 1.0);
    CHECK(detail::turn(-0.5).cos == -1.0);
    CHECK(detail::turn(1.75).sin == -1.0);
  }

  TEST_CASE("a track's spots are evenly spaced along it, with unit normals") {
    for (const detail::Track track : {detail::Track{35.0, 18.0, 30.0}, {0.0, 0.0, 2.0}, {5.0, 1.0, 0.5}}) {
      constexpr int kSpots = 20000;
      double length = 0.0, longest = 0.0;
      for (int i = 0; i < kSpots; ++i) {
        const detail::TrackSpot a = track.spot(static_cast<double>(i) / kSpots);
        const detail::TrackSpot b = track.spot(static_cast<double>((i + 1) % kSpots) / kSpots);
        const double step = std::hypot(b.x - a.x, b.z - a.z);
        length += step;
        longest = std::max(longest, step);
        CHECK(std::hypot(a.normal_x, a.normal_z) == doctest::Approx(1.0));
      }
      CHECK(length == doctest::Approx(track.length()).epsilon(1e-5));
      CHECK(longest == doctest::Approx(track.length() / kSpots).epsilon(1e-5));
    }
  }
}
