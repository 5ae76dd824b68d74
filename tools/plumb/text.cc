#include "text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "plumb/error.h"

namespace plumb::tool {
namespace {

constexpr int kMaxSide = 65535;
constexpr long kMaxPixels = 1L << 28;  // 2 GiB for a frame; the tool holds two

float parse_float(std::string_view option, std::string_view text) {
  float value = 0.0f;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
    throw Error(fmt::format("plumb: {}: '{}' is not a number", option, text));
  }
  // Beyond the floats from_chars leaves the value alone; strtof rounds it to zero or infinity.
  if (error == std::errc::result_out_of_range) value = std::strtof(std::string(text).c_str(), nullptr);
  if (!std::isfinite(value)) {
    throw Error(fmt::format("plumb: {}: '{}' is not a finite single-precision number", option, text));
  }
  return value;
}

int parse_side(std::string_view option, std::string_view size, std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error != std::errc() || value < 1 || value > kMaxSide) {
    throw Error(fmt::format("plumb: {}: '{}' is not a size; write WIDTHxHEIGHT with 1 to {} pixels a side",
                            option, size, kMaxSide));
  }
  return value;
}

}  // namespace

glm::vec3 parse_vec3(std::string_view option, std::string_view text) {
  const std::vector<std::string> parts = split_list(text);
  if (parts.size() != 3) {
    throw Error(fmt::format("plumb: {}: '{}' is not a point; write three numbers as X,Y,Z", option, text));
  }
  return {parse_float(option, parts[0]), parse_float(option, parts[1]), parse_float(option, parts[2])};
}

std::pair<int, int> parse_size(std::string_view option, std::string_view text) {
  const std::size_t x = text.find('x');
  const std::string_view after = x == std::string_view::npos ? std::string_view() : text.substr(x + 1);
  const int width = parse_side(option, text, text.substr(0, x));
  const int height = parse_side(option, text, after);
  if (static_cast<long>(width) * height > kMaxPixels) {
    throw Error(fmt::format("plumb: {}: '{}' is more than {} pixels", option, text, kMaxPixels));
  }
  return {width, height};
}

void check_threads(int threads) {
  if (threads < 0) throw Error(fmt::format("plumb: --threads {}: give 0 or more", threads));
}

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace plumb::tool
