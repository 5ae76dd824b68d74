#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <climits>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "plumb/camera.h"
#include "plumb/error.h"
#include "support/fp_modes.h"

using namespace plumb;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <typename V>
bool same_vector(const V& a, const V& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

// docs/visibility.md once more, in the plainest way there is: one operation a line, each stored in a
// volatile double, so that no compiler can fuse, reorder or widen it.
double add(double a, double b) {
  const volatile double x = a, y = b;
  const volatile double sum = x + y;
  return sum;
}
double subtract(double a, double b) { return add(a, -b); }
double multiply(double a, double b) {
  const volatile double x = a, y = b;
  const volatile double product = x * y;
  return product;
}
double divide(double a, double b) {
  const volatile double x = a, y = b;
  const volatile double quotient = x / y;
  return quotient;
}
float rounded(double a) {
  const volatile double x = a;
  const volatile float y = static_cast<float>(x);
  return y;
}

glm::dvec3 long_hand_normalize(const glm::dvec3& a) {
  const double sum = add(add(multiply(a.x, a.x), multiply(a.y, a.y)), multiply(a.z, a.z));
  const volatile double length = std::sqrt(sum);
  return {divide(a.x, length), divide(a.y, length), divide(a.z, length)};
}

glm::dvec3 long_hand_cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {subtract(multiply(p.y, q.z), multiply(p.z, q.y)), subtract(multiply(p.z, q.x), multiply(p.x, q.z)),
          subtract(multiply(p.x, q.y), multiply(p.y, q.x))};
}

Camera long_hand_look_at(const glm::vec3& eye, const glm::vec3& target, const glm::vec3& up, double fov,
                         int width, int height) {
  const double pi = 3.14159265358979311600;
  const glm::dvec3 f = long_hand_normalize(
      glm::dvec3(subtract(target.x, eye.x), subtract(target.y, eye.y), subtract(target.z, eye.z)));
  const glm::dvec3 r = long_hand_normalize(long_hand_cross(f, glm::dvec3(up)));
  const glm::dvec3 u = long_hand_cross(r, f);
  const double hh = rounded(std::tan(multiply(fov, divide(pi, 360.0))));
  const double hw = divide(multiply(hh, width), height);
  const double across = divide(multiply(2.0, hw), width);
  const double down = divide(multiply(2.0, hh), height);
  glm::dvec3 corner, du, dv;
  for (int i = 0; i < 3; ++i) {
    corner[i] = add(subtract(f[i], multiply(r[i], hw)), multiply(u[i], hh));
    du[i] = multiply(r[i], across);
    dv[i] = -multiply(u[i], down);
  }
  return {eye, corner, du, dv, width, height};
}

glm::vec3 long_hand_direction(const Camera& camera, int x, int y) {
  glm::vec3 direction;
  for (int i = 0; i < 3; ++i) {
    direction[i] = rounded(
        add(add(camera.corner[i], multiply(add(x, 0.5), camera.du[i])), multiply(add(y, 0.5), camera.dv[i])));
  }
  return direction;
}

bool same_camera(const Camera& a, const Camera& b) {
  return same_vector(a.eye, b.eye) && same_vector(a.corner, b.corner) && same_vector(a.du, b.du) &&
         same_vector(a.dv, b.dv) && a.width == b.width && a.height == b.height;
}

// What Python's doubles gave for the same formulas.
struct Known {
  glm::vec3 eye, target, up;
  double fov;
  int width, height;
  glm::dvec3 corner, du, dv;
  struct Pixel {
    int x, y;
    glm::vec3 direction;
  } pixels[3];
};

const Known kKnown[] = {
    {{-1100.0f, 180.0f, -40.0f},
     {400.0f, 300.0f, -20.0f},
     {0.0f, 1.0f, 0.0f},
     60.0,
     320,
     180,
     {0x1.edc3084940ca9p-1, 0x1.4f7cefb8849e3p-1, -0x1.037d78fdd9701p+0},
     {-0x1.66b8989265f7bp-14, 0.0, 0x1.a46052cb8f7e4p-8},
     {0x1.0c2909ba03dd6p-11, -0x1.a31330e83f369p-8, 0x1.c9a9065c2f8e6p-18},
     {{0, 0, {0x1.eddef2p-1f, 0x1.4dd9dcp-1f, -0x1.02ab1p+0f}},
      {319, 179, {0x1.07639p+0f, -0x1.f865f4p-2f, 0x1.0978f8p+0f}},
      {106, 90, {0x1.006626p+0f, 0x1.3982f2p-4f, -0x1.51cbdp-2f}}}},
    {{350.0f, -850.0f, 200.0f},
     {0.0f, 0.0f, 0.0f},
     {0.0f, 0.0f, 1.0f},
     40.0,
     320,
     180,
     {-0x1.ffe9832eeb582p-1, 0x1.751b3b27c3325p-1, 0x1.24f88d42a5421p-3},
     {0x1.ea24e82ea2ed1p-9, 0x1.93a5ec62a44abp-10, -0.0},
     {0x1.57422d505ff99p-12, -0x1.a0d05b98748a8p-11, -0x1.02f9ed9dc868ep-8},
     {{0, 0, {-0x1.fedefcp-1f, 0x1.754c0ap-1f, 0x1.20eca6p-3f}},
      {319, 179, {0x1.03cad2p-2f, 0x1.13f6cp+0f, -0x1.21ee58p-1f}},
      {106, 90, {-0x1.24d60cp-1f, 0x1.a43b14p-1f, -0x1.b77246p-3f}}}},
    {{350.9f, 4.3f, -107.1f},
     {463.0f, 16.0f, -56.3f},
     {0.0f, 1.0f, 0.0f},
     65.0,
     1280,
     720,
     {0x1.51bebb08ba717p+0, 0x1.752bc12cde378p-1, -0x1.4a877aea37711p-1},
     {-0x1.7ef5fb0780f1cp-11, 0.0, 0x1.a689ddb2f545ap-10},
     {0x1.3fe855193d3edp-13, -0x1.cdd179da52daep-10, 0x1.21f1652813726p-14},
     {{0, 0, {0x1.51abccp+0f, 0x1.74b84cp-1f, -0x1.4a195p-1f}},
      {1279, 719, {0x1.fa5766p-2f, -0x1.13cf5ep-1f, 0x1.776f5ep+0f}},
      {426, 360, {0x1.101216p+0f, 0x1.80081ap-4f, 0x1.11aa04p-4f}}}},
    // Subnormal throughout: the eye, the target and the up vector.
    {{0x1.16c2p-133f, 0.0f, 0.0f},
     {0.0f, 0x1.4e84p-135f, -0x1.16c28p-132f},
     {0.0f, 0x1.cp-147f, 0.0f},
     90.0,
     7,
     5,
     {-0x1.a2cf0cbffd630p+0, 0x1.1fc49d46c862ep+0, -0x1.21b290c4d135dp-3},
     {0x1.6e5b9ebb64196p-2, 0.0, -0x1.6e5af6824c2acp-3},
     {-0x1.85ba194f45a30p-6, -0x1.95f668dd18120p-2, -0x1.85bacc43b39bfp-5},
     {{0, 0, {-0x1.780f0ep+0f, 0x1.da0bap-1f, -0x1.04cbb2p-2f}},
      {6, 4, {0x1.2a3d7ep-1f, -0x1.51e132p-1f, -0x1.84ae8p+0f}},
      {2, 2, {-0x1.9a1e1ep-1f, 0x1.1054dep-3f, -0x1.6a4aaep-1f}}}},
};

Camera look(const Known& k) { return Camera::look_at(k.eye, k.target, k.up, k.fov, k.width, k.height); }

bool as_known(const Known& k) {
  const Camera camera = look(k);
  bool same = same_camera(camera, {k.eye, k.corner, k.du, k.dv, k.width, k.height});
  for (const Known::Pixel& pixel : k.pixels) {
    same = same && same_vector(camera.ray(pixel.x, pixel.y).direction, pixel.direction);
  }
  return same;
}

// A float of any finite magnitude and sign, now and then 0 or subnormal.
float any_float(std::mt19937& random, int least_exponent, int greatest_exponent) {
  if (random() % 8 == 0) return 0.0f;
  const int exponent = std::uniform_int_distribution<int>(least_exponent, greatest_exponent)(random);
  const float mantissa = 1.0f + static_cast<float>(random() & 0x7fffffu) * 0x1p-23f;
  return std::ldexp(random() % 2 == 0 ? mantissa : -mantissa, exponent);
}

glm::vec3 any_vector(std::mt19937& random, int least_exponent, int greatest_exponent) {
  const float x = any_float(random, least_exponent, greatest_exponent);
  const float y = any_float(random, least_exponent, greatest_exponent);
  return {x, y, any_float(random, least_exponent, greatest_exponent)};
}

std::string message_of_look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, double fov, int width,
                               int height) {
  try {
    Camera::look_at(eye, target, up, fov, width, height);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

const glm::vec3 kEye{1.0f, 2.0f, 3.0f}, kTarget{0.0f, 0.0f, 0.0f}, kUp{0.0f, 1.0f, 0.0f};

}  // namespace

TEST_SUITE("camera") {
  TEST_CASE("look_at and ray give the bits that another language's doubles give") {
    for (const Known& known : kKnown) CHECK(as_known(known));
  }

  TEST_CASE("look_at and ray equal the definition evaluated long-hand, at every scale") {
    std::mt19937 random(20240607);
    int cameras = 0;
    for (int i = 0; i < 4000; ++i) {
      CAPTURE(i);
      const int greatest = std::uniform_int_distribution<int>(-149, 127)(random);
      const int least = std::max(-149, greatest - static_cast<int>(random() % 40));
      const glm::vec3 eye = any_vector(random, least, greatest), target = any_vector(random, least, greatest);
      const glm::vec3 up = any_vector(random, -149, 127);
      const double fov = std::uniform_real_distribution<double>(0.001, 179.999)(random);
      const int width = 1 + static_cast<int>(random() % 4000), height = 1 + static_cast<int>(random() % 4000);
      if (message_of_look_at(eye, target, up, fov, width, height) != "no error") continue;
      ++cameras;
      const Camera camera = Camera::look_at(eye, target, up, fov, width, height);
      REQUIRE(same_camera(camera, long_hand_look_at(eye, target, up, fov, width, height)));
      for (int k = 0; k < 8; ++k) {
        const int x = static_cast<int>(random() % 4096) - 48, y = static_cast<int>(random() % 4096) - 48;
        REQUIRE(same_vector(camera.ray(x, y).direction, long_hand_direction(camera, x, y)));
      }
    }
    CHECK(cameras > 3000);
  }

  TEST_CASE("a ray starts at the eye, from 0 to infinity") {
    const Ray ray = Camera::look_at(kEye, kTarget, kUp, 45.0, 64, 48).ray(3, 4);
    CHECK(same_vector(ray.origin, kEye));
    CHECK(same_bits(ray.tmin, 0.0f));
    CHECK(ray.tmax == kInfinity);
  }

  TEST_CASE("pixels may lie outside the frame, up to the greatest ints") {
    const Camera camera = Camera::look_at(kEye, kTarget, kUp, 45.0, 64, 48);
    for (const int x : {INT_MIN, -1, 0, 64, INT_MAX}) {
      for (const int y : {INT_MIN, -1, 0, 48, INT_MAX}) {
        CHECK(same_vector(camera.ray(x, y).direction, long_hand_direction(camera, x, y)));
      }
    }
  }

  TEST_CASE("every pixel of a frame is rounded, not only some") {
    const Camera camera = look(kKnown[0]);
    int wrong = 0;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        wrong += same_vector(camera.ray(x, y).direction, long_hand_direction(camera, x, y)) ? 0 : 1;
      }
    }
    CHECK(wrong == 0);
  }

  TEST_CASE("a direction that is zero, overflows or is no number is returned as it is") {
    const Camera zero({0.0f, 0.0f, 0.0f}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 1, 1);
    CHECK(zero.ray(0, 0).direction == glm::vec3(0.0f, 0.0f, 0.0f));
    const double quiet_nan = std::numeric_limits<double>::quiet_NaN();
    const Camera wild({kInfinity, 0.0f, 0.0f}, {1e300, quiet_nan, -0x1.ffffffp+127}, {0.0, 0.0, 0.0},
                      {0.0, 0.0, 0.0}, 1, 1);
    const Ray ray = wild.ray(0, 0);
    CHECK(ray.origin.x == kInfinity);
    CHECK(ray.direction.x == kInfinity);
    CHECK(std::isnan(ray.direction.y));
    CHECK(ray.direction.z == -kInfinity);  // the midpoint between the greatest float and 2^128
  }

  TEST_CASE("small directions keep their subnormal floats") {
    const Camera small({0.0f, 0.0f, 0.0f}, {0x1p-149, 0x1.8p-150, 0x1p-150}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0},
                       1, 1);
    const glm::vec3 direction = small.ray(0, 0).direction;
    CHECK(same_bits(direction.x, 0x1p-149f));
    CHECK(same_bits(direction.y, 0x1p-149f));
    CHECK(same_bits(direction.z, 0.0f));  // a tie goes to the even float
  }

  TEST_CASE("the caller's floating-point mode changes no bit and is given back") {
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      const bool same = hard::under_mode(
          mode.bits, [] { return std::all_of(std::begin(kKnown), std::end(kKnown), as_known); });
      CHECK(same);
    }
  }
}

TEST_SUITE("camera errors") {
  TEST_CASE("an input that is not finite is named") {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 v(1.0f, 2.0f, 4.0f);
        v[axis] = bad;
        CHECK(contains(message_of_look_at(v, kTarget, kUp, 40.0, 4, 4), "eye is ("));
        CHECK(contains(message_of_look_at(kEye, v, kUp, 40.0, 4, 4), "target is ("));
        CHECK(contains(message_of_look_at(kEye, kTarget, v, 40.0, 4, 4), "up vector is ("));
      }
    }
  }

  TEST_CASE("a target equal to the eye is an error, its nearest neighbour is not") {
    CHECK(contains(message_of_look_at(kEye, kEye, kUp, 40.0, 4, 4), "target equals its eye"));
    CHECK(contains(message_of_look_at({0.0f, 1.0f, 2.0f}, {-0.0f, 1.0f, 2.0f}, kUp, 40.0, 4, 4),
                   "target equals its eye"));
    const glm::vec3 beside(std::nextafter(kEye.x, 9.0f), kEye.y, kEye.z);
    CHECK(message_of_look_at(kEye, beside, kUp, 40.0, 4, 4) == "no error");
    CHECK(message_of_look_at({0.0f, 0.0f, 0.0f}, {0x1p-149f, 0.0f, 0.0f}, kUp, 40.0, 4, 4) == "no error");
  }

  TEST_CASE("an up vector of zero or along the view is an error") {
    CHECK(contains(message_of_look_at(kEye, kTarget, {0.0f, -0.0f, 0.0f}, 40.0, 4, 4), "up vector"));
    CHECK(contains(message_of_look_at({0.0f, 5.0f, 0.0f}, kTarget, kUp, 40.0, 4, 4), "up vector"));
    CHECK(contains(message_of_look_at({0.0f, 5.0f, 0.0f}, kTarget, {0.0f, -1e30f, 0.0f}, 40.0, 4, 4),
                   "up vector"));
    CHECK(message_of_look_at({0.0f, 5.0f, 0.0f}, kTarget, {0x1p-149f, 1e30f, 0.0f}, 40.0, 4, 4) ==
          "no error");
  }

  TEST_CASE("a field of view must lie strictly between 0 and 180 degrees and not vanish") {
    for (const double fov :
         {0.0, -0.0, -40.0, 180.0, 360.0, static_cast<double>(kNan), static_cast<double>(kInfinity)}) {
      CHECK(contains(message_of_look_at(kEye, kTarget, kUp, fov, 4, 4), "field of view"));
    }
    CHECK(contains(message_of_look_at(kEye, kTarget, kUp, 1e-44, 4, 4), "rounds to 0"));
    CHECK(message_of_look_at(kEye, kTarget, kUp, 1e-40, 4, 4) == "no error");
    CHECK(message_of_look_at(kEye, kTarget, kUp, std::nextafter(180.0, 0.0), 4, 4) == "no error");
  }

  TEST_CASE("a size below 1 is an error, for both ways to make a camera") {
    CHECK(contains(message_of_look_at(kEye, kTarget, kUp, 40.0, 0, 4), "0 x 4 pixels"));
    CHECK(contains(message_of_look_at(kEye, kTarget, kUp, 40.0, 4, -1), "4 x -1 pixels"));
    CHECK_THROWS_AS(Camera(kEye, {}, {}, {}, 0, 1), Error);
    CHECK_THROWS_AS(Camera(kEye, {}, {}, {}, 1, INT_MIN), Error);
  }
}
