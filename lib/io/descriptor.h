#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace plumb::detail {

/// An open file of the system's, or none; closed when this ends.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;

  bool is_open() const { return number_ >= 0; }

  /// Reads from, or writes at, an offset. How many bytes before the file's end or a failure: then fewer
  /// than asked, with errno 0 at the end.
  std::size_t read_at(std::uint64_t offset, char* to, std::size_t bytes) const;
  std::size_t write_at(std::uint64_t offset, const char* from, std::size_t bytes) const;

 private:
  int number_ = -1;
};

/// What errno says.
std::string system_message();

}  // namespace plumb::detail
