#include "picture.h"

#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

#include "color.h"
#include "tool/half_seen.h"

using plumb::Frame;
using plumb::test::at;
using plumb::test::half_seen;
using plumb::test::kHeight;
using plumb::test::kWidth;

namespace {

plumb::tool::Rgb color_at(const plumb::tool::Image& image, int x, int y) {
  const std::size_t i = 3 * at(x, y);
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

}  // namespace

TEST_SUITE_BEGIN("tool: pictures");

TEST_CASE("a triangle has one colour in every frame, and nothing seen has the background's") {
  Frame a = half_seen(), b = half_seen();
  for (std::uint32_t& id : b.id) id = id == 7 ? 8 : id;
  b.id[at(0, 0)] = 7;
  const auto seven = color_at(plumb::tool::id_picture(a), 5, 8);
  CHECK(color_at(plumb::tool::id_picture(b), 0, 0) == seven);
  CHECK(color_at(plumb::tool::id_picture(b), 5, 8) != seven);
  CHECK(color_at(plumb::tool::id_picture(a), 5, 1) == color_at(plumb::tool::depth_picture(a), 5, 1));
}

TEST_CASE("near is brighter than far, and no depth looks like the background") {
  const plumb::tool::Image image = plumb::tool::depth_picture(half_seen());
  const auto near = color_at(image, 0, 8), far = color_at(image, kWidth - 1, 8);
  CHECK(int{near[0]} + near[1] + near[2] > int{far[0]} + far[1] + far[2]);
  const auto background = color_at(image, 0, 0);
  for (int x = 0; x < kWidth; ++x) CHECK(color_at(image, x, 8) != background);
}

TEST_CASE("a frame that sees nothing, and one of a single depth, have pictures") {
  const Frame nothing(kWidth, kHeight);
  const auto empty = plumb::tool::depth_picture(nothing);
  CHECK(color_at(empty, 0, 0) == color_at(empty, kWidth - 1, kHeight - 1));
  Frame wall(kWidth, kHeight);
  for (std::size_t i = 0; i < wall.id.size(); ++i) {
    wall.id[i] = 0;
    wall.depth[i] = 1.0f;
  }
  const auto flat = plumb::tool::depth_picture(wall);
  CHECK(color_at(flat, 0, 0) == color_at(flat, kWidth - 1, kHeight - 1));
  CHECK(color_at(flat, 0, 0) != color_at(empty, 0, 0));
}

TEST_CASE("a difference stands out: red for the id, orange for the depth, the rest is grey") {
  Frame other = half_seen();
  other.id[at(3, 7)] = 8;
  other.depth[at(15, 7)] = 3.0f;
  const plumb::tool::Image image = plumb::tool::difference_picture(half_seen(), other);
  CHECK(color_at(image, 3, 7) == plumb::tool::Rgb{226, 24, 30});
  CHECK(color_at(image, 15, 7) == plumb::tool::Rgb{255, 150, 0});
  const auto elsewhere = color_at(image, 9, 9);
  CHECK(elsewhere[0] == elsewhere[1]);
  CHECK(elsewhere[1] == elsewhere[2]);
  CHECK(color_at(image, 2, 6) != color_at(image, 9, 9));
}

TEST_SUITE_END();
