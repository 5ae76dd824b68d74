#include "io/vertex_rows.h"

#include <cstring>

#include "io/binary.h"

namespace plumb::detail {
namespace {

// Bytes that are sooner read than passed over.
constexpr std::size_t kNarrowGap = 4096;

template <bool kSwap>
float load_real(PlyType type, const char* at) {
  const auto integer = [&]<typename T>(T /*type*/) {
    return static_cast<float>(std::int64_t{load_binary<T, kSwap>(at)});
  };
  switch (type) {
    case PlyType::Int8:
      return integer(std::int8_t{});
    case PlyType::UInt8:
      return integer(std::uint8_t{});
    case PlyType::Int16:
      return integer(std::int16_t{});
    case PlyType::UInt16:
      return integer(std::uint16_t{});
    case PlyType::Int32:
      return integer(std::int32_t{});
    case PlyType::UInt32:
      return integer(std::uint32_t{});
    case PlyType::Float32:
      return load_binary<float, kSwap>(at);
    default:
      return static_cast<float>(load_binary<double, kSwap>(at));
  }
}

template <bool kSwap>
glm::vec3 load_row(const VertexRow& row, const char* bytes) {
  return {load_real<kSwap>(row.type[0], bytes + row.at[0]), load_real<kSwap>(row.type[1], bytes + row.at[1]),
          load_real<kSwap>(row.type[2], bytes + row.at[2])};
}

// Three floats of this machine, one behind the other.
bool is_plain(const VertexRow& row) {
  const VertexRow plain;
  return !row.swapped && row.type == plain.type && row.at[1] == row.at[0] + 4 && row.at[2] == row.at[0] + 8;
}

glm::vec3 load_plain_row(const VertexRow& row, const char* bytes) {
  glm::vec3 position;
  std::memcpy(&position, bytes + row.at[0], sizeof(position));
  return position;
}

}  // namespace

void gather_vertices(const std::function<void(std::uint64_t, char*, std::size_t)>& read, const VertexRow& row,
                     std::span<const std::uint32_t> numbers, std::span<char> buffer, glm::vec3* to) {
  const std::size_t most = buffer.size() / row.bytes;
  const std::size_t gap = kNarrowGap / row.bytes;
  const bool plain = is_plain(row);
  for (std::size_t i = 0; i < numbers.size();) {
    const std::uint32_t first = numbers[i];
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] - first < most &&
           numbers[end] - numbers[end - 1] <= gap + 1) {
      ++end;
    }
    const std::size_t rows = numbers[end - 1] - first + 1;
    read(first * std::uint64_t{row.bytes}, buffer.data(), rows * row.bytes);
    const auto load = [&](auto load_one) {
      for (; i < end; ++i) to[i] = load_one(row, buffer.data() + (numbers[i] - first) * row.bytes);
    };
    if (plain) {
      load([](const VertexRow& r, const char* bytes) { return load_plain_row(r, bytes); });
    } else if (row.swapped) {
      load([](const VertexRow& r, const char* bytes) { return load_row<true>(r, bytes); });
    } else {
      load([](const VertexRow& r, const char* bytes) { return load_row<false>(r, bytes); });
    }
  }
}

}  // namespace plumb::detail
