#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "plumb/frame.h"
#include "plumb/ray.h"
#include "report.h"
#include "tool/half_seen.h"
#include "verdict.h"

using plumb::Frame;
using plumb::test::at;
using plumb::test::half_seen;
using plumb::test::kHeight;
using plumb::test::kWidth;
using plumb::tool::Pair;

namespace {

Pair pair_of(const Frame& a, const Frame& b) {
  return {"bvh2", "raster", plumb::compare(a, b), std::nullopt};
}

}  // namespace

TEST_SUITE_BEGIN("tool: verdict");

TEST_CASE("equal frames agree: status 0, no list, no difference") {
  const std::vector<Pair> pairs = {pair_of(half_seen(), half_seen())};
  CHECK(plumb::tool::exit_status(pairs) == 0);
  CHECK(plumb::tool::differences(pairs[0]).empty());
  CHECK(plumb::tool::summary(pairs[0]) == "agrees with bvh2");
}

TEST_CASE("one pixel in one pair is enough for status 1, be it only the depth's last bit") {
  Frame other = half_seen();
  other.depth[at(3, 7)] = std::nextafter(other.depth[at(3, 7)], 9.0f);
  const std::vector<Pair> pairs = {pair_of(half_seen(), half_seen()), pair_of(half_seen(), other)};
  CHECK(plumb::tool::exit_status(pairs) == 1);
  CHECK(plumb::tool::summary(pairs[1]) == "DIFFERS from bvh2 in 1 of 200 pixels (id in 0, depth in 1)");
  CHECK(plumb::tool::differences(pairs[1]) ==
        "    pixel (3, 7): bvh2 saw triangle 7 at t 2.375, raster saw triangle 7 at t 2.3750002\n");
}

TEST_CASE("what each saw is listed, first pixels first, and the rest counted") {
  Frame other = half_seen();
  for (int y = 5; y < 7; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      other.id[at(x, y)] = plumb::kNone;
      other.depth[at(x, y)] = plumb::Hit().t;
    }
  }
  const std::string text = plumb::tool::differences(pair_of(half_seen(), other));
  CHECK(text.starts_with("    pixel (0, 5): bvh2 saw triangle 7 at t 2, raster saw nothing (t inf)\n"));
  CHECK(text.ends_with("    and 24 more\n"));
}

TEST_CASE("the JSON of a difference says who saw what, and null for nothing") {
  Frame other = half_seen();
  other.id[at(4, 1)] = 9;
  other.depth[at(4, 1)] = 1.5f;
  const plumb::tool::Scene scene = {
      "two frames", {}, plumb::Camera({0, 0, 0}, {0, 0, -1}, {0.1, 0, 0}, {0, -0.1, 0}, kWidth, kHeight)};
  plumb::tool::CompareReport report;
  report.pairs.push_back(pair_of(half_seen(), other));
  const nlohmann::json json = nlohmann::json::parse(plumb::tool::to_json(scene, 0, report));
  CHECK(json["agree"] == false);
  const nlohmann::json& pair = json["pairs"][0];
  CHECK(pair["agree"] == false);
  CHECK(pair["different_pixels"] == 1);
  REQUIRE(pair["first"].size() == 1);
  CHECK(pair["first"][0]["x"] == 4);
  CHECK(pair["first"][0]["y"] == 1);
  CHECK(pair["first"][0]["a"]["id"].is_null());
  CHECK(pair["first"][0]["a"]["t"].is_null());
  CHECK(pair["first"][0]["b"]["id"] == 9);
  CHECK(pair["first"][0]["b"]["t"] == 1.5);
}

TEST_SUITE_END();
