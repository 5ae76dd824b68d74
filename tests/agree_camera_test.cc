#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "oracle/oracle.h"
#include "plumb/camera.h"
#include "plumb/error.h"
#include "support/oracle_adapter.h"
#include "support/random.h"

// Camera::look_at against the oracle's, bit for bit, and its errors.

using namespace plumb;

namespace {

struct Look {
  glm::vec3 eye, target, up;
  double fov;
  int width, height;
};

glm::vec3 some_point(hard::Random& random) {
  switch (random.below(4)) {
    case 0:
      return random.unit3();
    case 1:
      return random.lattice3(2);
    case 2: {
      const float size = std::ldexp(1.0f, random.between(-149, 126));
      return size * random.unit3();
    }
    default:
      return 1000.0f * random.unit3();
  }
}

// Most are good, some lack an axis, a few are not finite or out of range.
Look some_look(hard::Random& random) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Look look{some_point(random),      some_point(random),
            some_point(random),      1.0 + 0.001 * random.below(178000),
            random.between(1, 2000), random.between(1, 2000)};
  if (random.one_in(2)) look.up = {0, 1, 0};
  switch (random.below(40)) {
    case 0:
      look.target = look.eye;
      break;
    case 1:
      look.up = look.target - look.eye;
      break;
    case 2:
      look.eye[random.between(0, 2)] = static_cast<float>(-kInf);
      break;
    case 3:
      look.target[random.between(0, 2)] = std::numeric_limits<float>::quiet_NaN();
      break;
    case 4:
      look.up[random.between(0, 2)] = static_cast<float>(kInf);
      break;
    case 5:
      look.fov = random.pick(std::vector<double>{0.0, -1.0, 180.0, 1e-60, 0x1p-149, 1e-40, kInf, -kInf});
      break;
    case 6:
      look.fov = random.pick(std::vector<double>{179.99999999999997, 90.0, 5e-324, 1e-43, 1e-44, 60.0});
      break;
    case 7:
      (random.one_in(2) ? look.width : look.height) = random.between(-1, 0);
      break;
    default:
      break;
  }
  return look;
}

std::optional<Camera> library_camera(const Look& look) {
  try {
    return Camera::look_at(look.eye, look.target, look.up, look.fov, look.width, look.height);
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool same(const glm::dvec3& a, const oracle::DVec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

TEST_SUITE("agree: camera") {
  TEST_CASE("look_at makes the oracle's camera and refuses what it refuses") {
    hard::Random random(1);
    std::size_t refused = 0;
    for (int i = 0; i < 20000; ++i) {
      CAPTURE(i);
      const Look look = some_look(random);
      const std::optional<Camera> camera = library_camera(look);
      const std::optional<oracle::Camera> expected =
          oracle::look_at(witness::to_oracle(look.eye), witness::to_oracle(look.target),
                          witness::to_oracle(look.up), look.fov, look.width, look.height);
      REQUIRE(camera.has_value() == expected.has_value());
      if (!camera) {
        ++refused;
        continue;
      }
      CHECK(same(camera->corner, expected->corner));
      CHECK(same(camera->du, expected->du));
      CHECK(same(camera->dv, expected->dv));
      CHECK(camera->eye == look.eye);
      CHECK(camera->width == look.width);
      CHECK(camera->height == look.height);
    }
    CHECK(refused > 1000);
    CHECK(refused < 10000);
  }
}
