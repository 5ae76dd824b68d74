#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/binary.h"
#include "io/ply_header.h"
#include "io/text.h"

namespace plumb::detail {

/// The values of a binary PLY body, one after the other. kSwap: the file's byte order is not this
/// machine's. PlyAsciiSource has the same interface.
template <bool kSwap>
class PlyBinarySource {
 public:
  PlyBinarySource(std::string_view bytes, const PlyHeader& header, const std::string& file)
      : begin_(bytes.data()), at_(begin_ + header.bytes), end_(begin_ + bytes.size()), file_(file) {}

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

  /// Passes over `count` values.
  void skip(std::uint64_t count, const PlyProperty& property) {
    const std::size_t size = size_of(property.type);
    if (count > static_cast<std::size_t>(end_ - at_) / size) fail_short(property);
    at_ += count * size;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    fail_in_file(
        file_,
        element_->name + " " + std::to_string(row_) + " (before byte " + std::to_string(at_ - begin_) + ")",
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
    if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) fail_short(property);
    const T value = load_binary<T, kSwap>(at_);
    at_ += sizeof(T);
    return value;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  const std::string& file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace plumb::detail
