#include "build/mesh_check.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <span>
#include <string>

#include "base/parallel.h"
#include "build/binned_sah.h"
#include "build_scenes.h"
#include "plumb/error.h"

using namespace plumb;
using namespace plumb::detail;

TEST_SUITE("mesh check") {
  TEST_CASE("a mesh too large for one tree is an error before it is read") {
    const glm::uvec3 nowhere{};
    MeshView mesh;
    mesh.triangles = std::span(&nowhere, std::size_t{1} << 31);
    Progress progress(nullptr, 1);
    CHECK_THROWS_AS(build_binned_sah(mesh, {}, progress), Error);
  }

  TEST_CASE("an index out of range is named with its triangle") {
    TriangleMesh mesh = build_scenes::soup(100, 1.0f, 0.1f, 30);
    CHECK_NOTHROW(check_mesh(mesh, 0, "Test"));
    for (int corner = 0; corner < 3; ++corner) {
      for (const std::uint32_t index : {300u, 0xffffffffu}) {
        TriangleMesh wrong = mesh;
        wrong.triangles[57][corner] = index;
        std::string message;
        try {
          check_mesh(wrong, 0, "Test");
        } catch (const Error& error) {
          message = error.what();
        }
        CHECK(message.find("Test") != std::string::npos);
        CHECK(message.find("triangle 57") != std::string::npos);
        CHECK(message.find(std::to_string(index)) != std::string::npos);
        CHECK(message.find("300 positions") != std::string::npos);
      }
    }
    CHECK_NOTHROW(check_mesh(TriangleMesh{}, 0, "Test"));
    CHECK_THROWS_AS(check_mesh(TriangleMesh{{}, {{0, 0, 0}}}, 0, "Test"), Error);
  }

  TEST_CASE("no id may be the one that means none") {
    const TriangleMesh mesh = build_scenes::soup(100, 1.0f, 0.1f, 31);
    CHECK_NOTHROW(check_mesh(mesh, 0xffffffffu - 100, "Test"));
    CHECK_THROWS_AS(check_mesh(mesh, 0xffffffffu - 99, "Test"), Error);
    CHECK_THROWS_AS(check_mesh(mesh, 0xffffffffu, "Test"), Error);
    CHECK_NOTHROW(check_mesh(TriangleMesh{}, 0xffffffffu, "Test"));
  }
}
