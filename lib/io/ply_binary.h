#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "io/binary.h"
#include "io/cursor.h"
#include "io/ply_header.h"
#include "io/text.h"

namespace plumb::detail {

/// The values of a binary PLY body, one after the other. kSwap: the file's byte order is not this
/// machine's. PlyAsciiSource has the same interface.
template <bool kSwap, class Cursor>
class PlyBinarySource {
 public:
  /// The cursor is at the body's beginning.
  PlyBinarySource(Cursor body, const PlyHeader& /*header*/, const std::string& file)
      : body_(std::move(body)), file_(file) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
  }
  void end_row() {}

  /// The next value, rounded once to the nearest float.
  float real(const PlyProperty& property) {
    switch (property.type) {
      case PlyType::Float32:
        return load<float>(property);
      case PlyType::Float64:
        return static_cast<float>(load<double>(property));
      default:
        return static_cast<float>(integer(property.type, property));
    }
  }

  /// The next value, of an integer type: of the property's entries or of its list's length.
  std::int64_t integer(PlyType type, const PlyProperty& property) {
    std::int64_t result = 0;
    read_integers(1, type, property, [&](std::int64_t value) { result = value; });
    return result;
  }

  /// Gives the next `count` entries, of an integer type, to `take`.
  template <typename Take>
  void integers(std::uint64_t count, const PlyProperty& property, const Take& take) {
    read_integers(count, property.type, property, take);
  }

  /// The commonest rows faster: as long as a row of `face` is a byte 3 and three 32-bit indices below
  /// `vertices`, and at most `rows` times, gives them to `take`, until that returns false. Returns how
  /// many rows were read. Whatever else comes next is for the other functions, with its errors.
  template <typename Take>
  std::uint64_t plain_triangles(const PlyElement& face, std::uint64_t rows, std::uint64_t vertices,
                                const Take& take) {
    const PlyProperty& corners = face.properties.front();
    const bool is_signed = corners.type == PlyType::Int32;
    if (face.properties.size() != 1 || size_of(corners.count_type) != 1) return 0;
    if (!is_signed && corners.type != PlyType::UInt32) return 0;
    if (is_signed) vertices = std::min(vertices, std::uint64_t{1} << 31);  // what is above is negative
    constexpr std::size_t kRowBytes = 13;
    if (!body_.hold(kRowBytes)) return 0;
    rows = std::min<std::uint64_t>(rows, static_cast<std::size_t>(body_.end - body_.at) / kRowBytes);
    const char* at = body_.at;
    std::uint64_t row = 0;
    for (; row < rows && *at == 3; ++row, at += kRowBytes) {
      const auto a = load_binary<std::uint32_t, kSwap>(at + 1);
      const auto b = load_binary<std::uint32_t, kSwap>(at + 5);
      const auto c = load_binary<std::uint32_t, kSwap>(at + 9);
      if (std::max({a, b, c}) >= vertices || !take(a, b, c)) break;
    }
    body_.at = at;
    return row;
  }

  /// Passes over `count` values.
  void skip(std::uint64_t count, const PlyProperty& property) {
    const std::size_t size = size_of(property.type);
    if (count > body_.left() / size) fail_short(property);
    body_.skip(count * size);
  }

  [[noreturn]] void fail(const std::string& reason) const {
    fail_in_file(
        file_,
        element_->name + " " + std::to_string(row_) + " (before byte " + std::to_string(body_.offset()) + ")",
        reason);
  }

 private:
  [[noreturn]] void fail_short(const PlyProperty& property) const {
    fail("the file ends within property " + in_quotes(property.name) + "; it is cut short");
  }

  // The type is asked once for all values.
  template <typename Take>
  void read_integers(std::uint64_t count, PlyType type, const PlyProperty& property, const Take& take) {
    const auto read = [&]<typename T>(T /*type*/) {
      for (std::uint64_t i = 0; i < count; ++i) take(std::int64_t{load<T>(property)});
    };
    switch (type) {
      case PlyType::Int8:
        return read(std::int8_t{});
      case PlyType::UInt8:
        return read(std::uint8_t{});
      case PlyType::Int16:
        return read(std::int16_t{});
      case PlyType::UInt16:
        return read(std::uint16_t{});
      case PlyType::Int32:
        return read(std::int32_t{});
      default:
        return read(std::uint32_t{});
    }
  }

  template <typename T>
  T load(const PlyProperty& property) {
    if (!body_.hold(sizeof(T))) fail_short(property);
    const T value = load_binary<T, kSwap>(body_.at);
    body_.at += sizeof(T);
    return value;
  }

  Cursor body_;
  const std::string& file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace plumb::detail
