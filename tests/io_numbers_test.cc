#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "io/text.h"
#include "io_util.h"

using namespace plumb;
using namespace plumb::test;

namespace {

std::string print(const char* format, int digits, double value) {
  std::array<char, 256> text;
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

// All of the text must be the number.
bool parse(const std::string& text, float& value) {
  return detail::parse_float(text.data(), text.data() + text.size(), value) == text.data() + text.size();
}

void check_as_strtof(const std::string& text) {
  float value = -7.0f;
  const bool parsed = parse(text, value);
  if (!parsed || !same_bits(value, std::strtof(text.c_str(), nullptr))) FAIL_CHECK(text);
}

// A decimal a little above or below one that ends in a nonzero digit, in scientific notation.
std::string nudged(const std::string& text, bool up) {
  const std::size_t exponent = text.find('e');
  std::string digits = text.substr(0, exponent);
  if (up) return digits + "0000001" + text.substr(exponent);
  const std::size_t last = digits.find_last_of("123456789");
  digits[last] = static_cast<char>(digits[last] - 1);
  return digits + "9999999" + text.substr(exponent);
}

}  // namespace

TEST_SUITE("text numbers") {
  TEST_CASE("a printed float reads back as itself, any float, any precision as strtof says") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 300000; ++i) {
      const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
      if (std::isnan(value)) continue;
      float back = 0.0f;
      if (!parse(print("%.*g", 9, value), back) || !same_bits(back, value)) FAIL_CHECK(value);
      check_as_strtof(print("%.*e", static_cast<int>(random() % 20), value));
    }
  }

  TEST_CASE("random decimals round as strtof rounds") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 400000; ++i) {
      std::string text = random() % 2 == 0 ? "-" : "";
      const std::uint64_t digits = 1 + random() % 25;
      const std::uint64_t point = random() % (digits + 1);
      for (std::uint64_t d = 0; d < digits; ++d) {
        if (d == point) text += '.';
        text += static_cast<char>('0' + random() % 10);
      }
      if (random() % 4 != 0) text.append("e").append(std::to_string(static_cast<int>(random() % 120) - 70));
      check_as_strtof(text);
    }
  }

  TEST_CASE("halfway between two floats goes to the even one, a hair beside it to the nearer") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 100000; ++i) {
      const auto bits = static_cast<std::uint32_t>(random() % 0x7f800000u);
      const double low = std::bit_cast<float>(bits);
      const double high = bits + 1 == 0x7f800000u ? 0x1p128 : double{std::bit_cast<float>(bits + 1)};
      const std::string middle = print("%.*e", 125, (low + high) / 2);  // exact: at most 113 digits
      check_as_strtof(middle);
      check_as_strtof(nudged(middle, true));
      check_as_strtof(nudged(middle, false));
    }
  }

  TEST_CASE("a decimal is not rounded by way of double") {
    float value = 0.0f;
    REQUIRE(parse("1.000000059604644775390625000001", value));  // above 1 + 2^-24; the double is equal to it
    CHECK(value == 1.0f + 0x1p-23f);
  }

  TEST_CASE("too large is infinite and too small is zero, with the sign kept") {
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<std::pair<std::string, float>> cases = {
        {"1e50", inf},
        {"-1e50", -inf},
        {"1e-50", 0.0f},
        {"-1e-50", -0.0f},
        {"1e400", inf},
        {"1e-400", 0.0f},
        {"1e99999999999999999999", inf},
        {"1e+99999999999999999999", inf},
        {"-1e-99999999999999999999", -0.0f},
        {"0e99999999999999999999", 0.0f},
        {"340282356779733661637539395458142568447", std::numeric_limits<float>::max()},
        {"340282356779733661637539395458142568448", inf},
        {"0.00000000000000000000000000000000000000000000000000001", 0.0f},
        {"0." + std::string(300, '0') + "1e301", 1.0f},
        {"0." + std::string(120, '0') + "1e60", 0.0f},
        {"0." + std::string(300, '0') + "1e350", inf},
        {"1" + std::string(300, '0'), inf},
        {"1" + std::string(300, '0') + "e-300", 1.0f},
        {"1" + std::string(300, '0') + "e-350", 0.0f},
        {"1e-45", std::numeric_limits<float>::denorm_min()},
        {"1e-40", 1e-40f},
    };
    for (const auto& entry : cases) {
      const std::string& text = entry.first;
      CAPTURE(text);
      float value = -7.0f;
      REQUIRE(parse(text, value));
      CHECK(same_bits(value, entry.second));
      CHECK(same_bits(value, std::strtof(text.c_str(), nullptr)));
    }
  }

  TEST_CASE("signs, nan and inf are numbers") {
    for (const char* text : {"+1.5", "-1.5", "+.5", "5.", "inf", "-inf", "+inf", "Infinity", "INF"}) {
      check_as_strtof(text);
    }
    for (const char* text : {"nan", "-nan", "NaN", "+nan"}) {
      float value = 0.0f;
      CHECK(parse(text, value));
      CHECK(std::isnan(value));
    }
  }

  TEST_CASE("other text is not a number") {
    const std::string too_long = "0." + std::string(5000, '0') + "1";
    for (const std::string text : {"", "+", "-", ".", "e5", "+-1", "++1", "--1", "abc", "0x10", "1,5", "1e",
                                   "1.0d5", "1.#INF", " 1", too_long.c_str()}) {
      CAPTURE(text);
      float value = 0.0f;
      CHECK_FALSE(parse(text, value));
    }
  }

  TEST_CASE("what a message quotes is short and printable") {
    CHECK(detail::in_quotes("abc") == "\"abc\"");
    CHECK(detail::in_quotes(std::string_view("a\0\n\xff", 4)) == "\"a\\x00\\x0a\\xff\"");
    CHECK(detail::in_quotes(std::string(1000, 'x')).size() < 60);
  }
}
