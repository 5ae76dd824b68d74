#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>

#include "plumb/error.h"
#include "plumb/frame.h"
#include "plumb/ray.h"

using namespace plumb;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string message_of_compare(const Frame& a, const Frame& b) {
  try {
    compare(a, b);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("frame") {
  TEST_CASE("a new frame sees nothing in every pixel") {
    const Frame frame(3, 2);
    CHECK(frame.width == 3);
    CHECK(frame.height == 2);
    REQUIRE(frame.depth.size() == 6);
    REQUIRE(frame.id.size() == 6);
    for (const float depth : frame.depth) CHECK(depth == kInfinity);
    for (const std::uint32_t id : frame.id) CHECK(id == kNone);
  }

  TEST_CASE("clear makes a used frame new") {
    Frame frame(4, 3);
    for (float& depth : frame.depth) depth = 1.0f;
    for (std::uint32_t& id : frame.id) id = 7;
    frame.clear();
    CHECK(compare(frame, Frame(4, 3)).equal());
  }

  TEST_CASE("a size below 1 is an error that names it") {
    CHECK_THROWS_AS(Frame(0, 1), Error);
    CHECK_THROWS_AS(Frame(1, 0), Error);
    CHECK_THROWS_AS(Frame(-65536, -65536), Error);
    CHECK_THROWS_WITH(Frame(-3, 5), "plumb: frame of -3 x 5 pixels; width and height must be at least 1");
  }
}

TEST_SUITE("compare") {
  TEST_CASE("a frame equals itself, NaN and infinite depths included") {
    Frame frame(5, 4);
    frame.depth[3] = std::numeric_limits<float>::quiet_NaN();
    frame.id[3] = 1;
    frame.depth[4] = 0.5f;
    const Comparison same = compare(frame, frame);
    CHECK(same.equal());
    CHECK(same.pixels == 20);
    CHECK(same.different_pixels == 0);
    CHECK(same.first.empty());
  }

  TEST_CASE("ids and depths are counted apart, pixels once") {
    const Frame a(4, 2);
    Frame b = a;
    b.id[1] = 9;        // (1, 0): id only
    b.depth[6] = 2.5f;  // (2, 1): depth only
    b.id[7] = 0;        // (3, 1): both
    b.depth[7] = 1.0f;
    const Comparison c = compare(a, b);
    CHECK_FALSE(c.equal());
    CHECK(c.different_ids == 2);
    CHECK(c.different_depths == 2);
    CHECK(c.different_pixels == 3);
    REQUIRE(c.first.size() == 3);
    CHECK(c.first[0].x == 1);
    CHECK(c.first[0].y == 0);
    CHECK(c.first[0].id_a == kNone);
    CHECK(c.first[0].id_b == 9);
    CHECK(c.first[1].x == 2);
    CHECK(c.first[1].y == 1);
    CHECK(c.first[1].depth_a == kInfinity);
    CHECK(c.first[1].depth_b == 2.5f);
    CHECK(c.first[2].x == 3);
    CHECK(c.first[2].y == 1);
    CHECK(c.first[2].id_b == 0);
    CHECK(c.first[2].depth_b == 1.0f);
  }

  TEST_CASE("depths are compared as bits: one ulp, the sign of zero and subnormals show") {
    Frame a(4, 1);
    Frame b(4, 1);
    a.depth = {1.0f, 0.0f, 0.0f, 2.0f};
    b.depth = {std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0f) + 1), -0.0f,
               std::numeric_limits<float>::denorm_min(), 2.0f};
    const Comparison c = compare(a, b);
    CHECK(c.different_depths == 3);
    CHECK(c.different_ids == 0);
    CHECK(c.different_pixels == 3);
  }

  TEST_CASE("only the first differences are listed, in row order, and all are counted") {
    const Frame a(10, 10);
    Frame b = a;
    for (std::uint32_t& id : b.id) id = 1;
    const Comparison c = compare(a, b);
    CHECK(c.different_pixels == 100);
    REQUIRE(c.first.size() == Comparison::kMaxListed);
    for (std::size_t i = 0; i < c.first.size(); ++i) {
      CHECK(c.first[i].x == static_cast<int>(i % 10));
      CHECK(c.first[i].y == static_cast<int>(i / 10));
    }
  }

  TEST_CASE("frames of different sizes are an error that names both") {
    const std::string message = message_of_compare(Frame(3, 2), Frame(2, 3));
    CHECK(message.find("3 x 2") != std::string::npos);
    CHECK(message.find("2 x 3") != std::string::npos);
  }

  TEST_CASE("a frame whose vectors do not fit its size is an error") {
    const Frame whole(3, 2);
    Frame torn = whole;
    torn.depth.pop_back();
    CHECK(message_of_compare(whole, torn).find("the second frame is 3 x 2 but holds 5 depths") !=
          std::string::npos);
    torn = whole;
    torn.id.push_back(0);
    CHECK_THROWS_AS(compare(torn, whole), Error);
    torn = whole;
    torn.width = -3;
    torn.height = -2;
    CHECK_THROWS_AS(compare(torn, whole), Error);
  }
}
