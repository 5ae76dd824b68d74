#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "plumb/builtin.h"
#include "plumb/error.h"

using namespace plumb;

namespace {

// Whether the camera, as a pinhole, has the point strictly inside its frame.
bool in_view(const Camera& camera, const glm::vec3& p) {
  const glm::dvec3 v = glm::dvec3(p) - glm::dvec3(camera.eye);
  // v = s (corner + a du + b dv), by Cramer's rule.
  const auto det = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  };
  const double whole = det(camera.corner, camera.du, camera.dv);
  const double s = det(v, camera.du, camera.dv) / whole;
  const double a = det(camera.corner, v, camera.dv) / whole / s;
  const double b = det(camera.corner, camera.du, v) / whole / s;
  return s > 0.0 && a > 0.0 && a < camera.width && b > 0.0 && b < camera.height;
}

// A mesh whose box is the given one.
TriangleMesh box_mesh(const glm::vec3& lo, const glm::vec3& hi) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    mesh.triangles.emplace_back(i, (i + 1) % 8, (i + 2) % 8);
  }
  return mesh;
}

bool all_in_view(const TriangleMesh& mesh, const Camera& camera) {
  return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                     [&](const glm::vec3& p) { return in_view(camera, p); });
}

}  // namespace

TEST_SUITE("frame_all") {
  TEST_CASE("the whole box is in view, whatever its shape, place and the frame's") {
    const glm::vec3 boxes[][2] = {
        {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}},
        {{100.0f, 200.0f, 300.0f}, {101.0f, 205.0f, 300.5f}},
        {{-5000.0f, 0.0f, -5000.0f}, {5000.0f, 0.0f, 5000.0f}},
        {{0.0f, 0.0f, 0.0f}, {0.0f, 1e-3f, 0.0f}},
        {{1e6f, 1e6f, 1e6f}, {1e6f + 1.0f, 1e6f, 1e6f}},
        {{-1e37f, -1e37f, -1e37f}, {1e37f, 1e37f, 1e37f}},
        {{-1e-40f, 0.0f, 0.0f}, {1e-40f, 2e-40f, 1e-40f}},
    };
    for (const auto& box : boxes) {
      const TriangleMesh mesh = box_mesh(box[0], box[1]);
      CAPTURE(box[1].x);
      CHECK(all_in_view(mesh, frame_all(mesh, 1280, 720)));
      CHECK(all_in_view(mesh, frame_all(mesh, 100, 900)));
      CHECK(all_in_view(mesh, frame_all(mesh, 33, 33, 100.0)));
      CHECK(all_in_view(mesh, frame_all(mesh, 640, 480, 8.0)));
    }
  }

  TEST_CASE("the eye is in front and above") {
    const TriangleMesh mesh = box_mesh({-1.0f, -2.0f, -3.0f}, {1.0f, 2.0f, 3.0f});
    const Camera camera = frame_all(mesh, 64, 48);
    CHECK(camera.eye.z > 3.0f);
    CHECK(camera.eye.y > 2.0f);
  }

  TEST_CASE("a mesh of nothing, or of one point, gives a camera") {
    CHECK(frame_all(TriangleMesh{}, 64, 48).width == 64);
    for (const float where : {0.0f, 1.0f, -1e-45f, 1e30f, 3e38f}) {
      TriangleMesh point;
      point.positions.assign(3, glm::vec3(where, where, where));
      point.triangles.emplace_back(0, 1, 2);
      CAPTURE(where);
      CHECK(all_in_view(point, frame_all(point, 64, 48)));
    }
  }

  TEST_CASE("only vertices of finite triangles count") {
    TriangleMesh mesh = box_mesh({-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f});
    const Camera expected = frame_all(mesh, 64, 48);
    mesh.positions.emplace_back(1e30f, 0.0f, 0.0f);  // of no triangle
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
    mesh.positions.emplace_back(std::numeric_limits<float>::infinity(), 0.0f, 0.0f);
    mesh.triangles.emplace_back(8, 9, 0);
    mesh.triangles.emplace_back(0, 8, 10);
    const Camera camera = frame_all(mesh, 64, 48);
    CHECK(camera.eye == expected.eye);
    CHECK(camera.corner == expected.corner);
  }

  TEST_CASE("what cannot be framed is an error that says why") {
    const TriangleMesh huge = box_mesh({-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f});
    CHECK_THROWS_WITH_AS(frame_all(huge, 64, 48), doctest::Contains("the mesh is so large"), Error);
    TriangleMesh broken = box_mesh({-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f});
    broken.triangles.emplace_back(0, 8, 1);
    CHECK_THROWS_WITH_AS(frame_all(broken, 64, 48), doctest::Contains("triangle 8 has the vertex index 8"),
                         Error);
    CHECK_THROWS_WITH_AS(frame_all(broken, 0, 48), doctest::Contains("0 x 48"), Error);
    CHECK_THROWS_WITH_AS(frame_all(broken, 64, 48, 180.0), doctest::Contains("field of view"), Error);
    CHECK_THROWS_WITH_AS(frame_all(broken, 64, 48, std::numeric_limits<double>::quiet_NaN()),
                         doctest::Contains("field of view"), Error);
  }
}
