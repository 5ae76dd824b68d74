#pragma once

#include <doctest/doctest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_builder.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "plumb/error.h"
#include "plumb/io.h"
#include "plumb/stream.h"
#include "stream_check.h"

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

/// Reads a copy of the bytes that ends where they end, so that a sanitizer sees one byte too many; and checks
/// that streaming them gives the same mesh and report, or the same error.
inline Loaded read_exact(const std::string& file, std::string_view bytes,
                         const detail::MeshLimits& limits = {}) {
  const auto copy = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), copy.get());
  const auto reader = file.ends_with(".ply")   ? detail::read_ply
                      : file.ends_with(".obj") ? detail::read_obj
                      : file.ends_with(".stl") ? detail::read_stl
                                               : detail::read_off;
  const std::string_view exact(copy.get(), bytes.size());
  Outcome whole =
      outcome_of([&](Outcome& outcome) { outcome.mesh = reader(exact, file, outcome.report, limits); });
  CHECK(stream_difference(file, exact, limits, whole, smallest_sizes(exact, 1)) == "");
  CHECK(stream_difference(file, exact, limits, whole, smallest_sizes(exact, 3, 16)) == "");
  CHECK(stream_difference(file, exact, limits, whole, detail::stream_sizes(detail::kLeastStreamMemory)) ==
        "");
  if (!whole.error.empty()) throw Error(whole.error);
  return {std::move(whole.mesh), whole.report};
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

/// What load_mesh says of a file; and checks that stream_mesh says the same.
inline std::string error_of_loading(const std::filesystem::path& path) {
  std::string error = error_of([&] { load_mesh(path); });
  CHECK(error_of([&] { stream_mesh(path, [](MeshView, std::uint32_t) {}); }) == error);
  return error;
}

/// What load_mesh says of a file in the folder that may not be read.
inline std::string error_of_loading_unreadable(const TempDir& dir, const std::filesystem::path& path) {
  std::filesystem::permissions(path, std::filesystem::perms::none);
  std::filesystem::permissions(dir.path(), std::filesystem::perms::all);
  const bool root = geteuid() == 0;  // root may read anything, nobody may not
  if (root && seteuid(65534) != 0) throw std::runtime_error("seteuid");
  std::string error = error_of_loading(path);
  if (root && seteuid(0) != 0) throw std::runtime_error("seteuid");
  return error;
}

/// A file and what must be said of it.
struct Case {
  std::string bytes, place, reason;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline void check_cases(const std::string& file, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const std::string error = error_of_reading(file, c.bytes);
    CAPTURE(c.bytes);
    CAPTURE(error);
    CHECK(error.starts_with(file + ": " + c.place));
    CHECK(contains(error, c.reason));
  }
}

inline bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace plumb::test
