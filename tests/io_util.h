#pragma once

#include <stdlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "io/mesh_builder.h"
#include "io/obj.h"
#include "io/ply.h"
#include "plumb/error.h"

// What the tests of the mesh readers share: making files, reading them, and what an error said.

namespace plumb::test {

/// A folder that lives as long as this.
class TempDir {
 public:
  TempDir() {
    std::string name = (std::filesystem::temp_directory_path() / "plumb_io_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp " + name);
    path_ = name;
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream out(path_ / name, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

struct Loaded {
  TriangleMesh mesh;
  MeshReport report;
};

/// Reads a copy of the bytes that ends where they end, so that a sanitizer sees one byte too many.
inline Loaded read_exact(const std::string& file, std::string_view bytes,
                         const detail::MeshLimits& limits = {}) {
  const auto copy = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), copy.get());
  Loaded loaded;
  const auto reader = file.ends_with(".ply") ? detail::read_ply : detail::read_obj;
  loaded.mesh = reader({copy.get(), bytes.size()}, file, loaded.report, limits);
  return loaded;
}

/// The message of the plumb::Error that `work` throws, or "no error".
template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

inline std::string error_of_reading(const std::string& file, std::string_view bytes,
                                    const detail::MeshLimits& limits = {}) {
  return error_of([&] { read_exact(file, bytes, limits); });
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace plumb::test
