// How fast mesh files load, against reading their bytes and parsing their numbers with std::from_chars.
//
//     plumb_files_bench [TRIANGLES] [FOLDER]
//
// Writes the built-in terrain of so many triangles (10^7 unless said) into FOLDER (the system's for temporary
// files) in every format, loads each and prints a table in Markdown: medians of interleaved rounds, on
// one thread. The files lie in the page cache, so no disk is timed. A loaded mesh must be the one written.

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "machine.h"
#include "plumb/builtin.h"
#include "plumb/io.h"
#include "timing.h"

namespace {

using namespace plumb;
namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little,
              "the binary files are written as memory holds them");

constexpr int kRounds = 5;

/// Collects a file's text or bytes; writes them in large pieces.
class Writer {
 public:
  explicit Writer(const fs::path& path) : file_(path, std::ios::binary), path_(path) {}
  ~Writer() { flush(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void text(const char* words) { buffer_ += words; }
  template <typename Number>
  void number(Number value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof(digits), value);
    buffer_.append(digits, error == std::errc() ? end : digits);
  }
  void vector(const glm::vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      text(" ");
      number(v[axis]);
    }
  }
  template <typename T>
  void bytes(const T& value) {
    const char* const data = reinterpret_cast<const char*>(&value);
    buffer_.append(data, data + sizeof(T));
  }
  void row_end() {
    text("\n");
    spill();
  }
  void spill() {
    if (buffer_.size() > (1u << 20)) flush();
  }

 private:
  void flush() {
    file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (!file_) std::cerr << path_.string() << ": cannot be written\n";
    buffer_.clear();
  }
  std::ofstream file_;
  fs::path path_;
  std::string buffer_;
};

void ply_header(Writer& out, const char* format, const TriangleMesh& mesh) {
  out.text(("ply\nformat " + std::string(format) + " 1.0\nelement vertex " +
            std::to_string(mesh.positions.size()) +
            "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
            std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n")
               .c_str());
}

void write_rows(Writer& out, const TriangleMesh& mesh, const char* vertex, const char* face,
                std::uint32_t first_index) {
  for (const glm::vec3& p : mesh.positions) {
    out.text(vertex);
    out.vector(p);
    out.row_end();
  }
  for (const glm::uvec3& t : mesh.triangles) {
    out.text(face);
    for (int k = 0; k < 3; ++k) {
      out.text(" ");
      out.number(t[k] + first_index);
    }
    out.row_end();
  }
}

void write_ply_text(Writer& out, const TriangleMesh& mesh) {
  ply_header(out, "ascii", mesh);
  write_rows(out, mesh, "", "3", 0);
}

void write_ply_binary(Writer& out, const TriangleMesh& mesh) {
  ply_header(out, "binary_little_endian", mesh);
  for (const glm::vec3& p : mesh.positions) {
    out.bytes(p);
    out.spill();
  }
  for (const glm::uvec3& t : mesh.triangles) {
    out.text("\3");
    out.bytes(t);
    out.spill();
  }
}

void write_obj(Writer& out, const TriangleMesh& mesh) { write_rows(out, mesh, "v", "f", 1); }

void write_off(Writer& out, const TriangleMesh& mesh) {
  out.text("OFF\n");
  out.number(mesh.positions.size());
  out.text(" ");
  out.number(mesh.triangles.size());
  out.text(" 0\n");
  write_rows(out, mesh, "", "3", 0);
}

void write_stl_text(Writer& out, const TriangleMesh& mesh) {
  out.text("solid terrain\n");
  for (const glm::uvec3& t : mesh.triangles) {
    out.text("facet normal 0 0 0\nouter loop\n");
    for (int k = 0; k < 3; ++k) {
      out.text("vertex");
      out.vector(mesh.positions[t[k]]);
      out.row_end();
    }
    out.text("endloop\nendfacet\n");
  }
  out.text("endsolid terrain\n");
}

void write_stl_binary(Writer& out, const TriangleMesh& mesh) {
  out.text(std::string(80, ' ').c_str());
  out.bytes(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const glm::uvec3& t : mesh.triangles) {
    out.bytes(glm::vec3(0.0f));
    for (int k = 0; k < 3; ++k) out.bytes(mesh.positions[t[k]]);
    out.bytes(std::uint16_t{0});
    out.spill();
  }
}

struct Format {
  const char* name;
  const char* extension;
  bool text;
  bool indexed;  // has vertices that triangles share
  void (*write)(Writer&, const TriangleMesh&);
};

constexpr Format kFormats[] = {
    {"PLY, binary", "ply", false, true, write_ply_binary},
    {"PLY, text", "ply", true, true, write_ply_text},
    {"OBJ", "obj", true, true, write_obj},
    {"OFF", "off", true, true, write_off},
    {"STL, binary", "stl", false, false, write_stl_binary},
    {"STL, text", "stl", true, false, write_stl_text},
};

bool same_mesh(const TriangleMesh& loaded, const TriangleMesh& mesh, bool indexed) {
  if (loaded.triangles.size() != mesh.triangles.size()) return false;
  if (indexed) return loaded.positions == mesh.positions && loaded.triangles == mesh.triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (loaded.positions[loaded.triangles[i][k]] != mesh.positions[mesh.triangles[i][k]]) return false;
    }
  }
  return true;
}

std::vector<char> read_bytes(const fs::path& path) {
  std::vector<char> bytes(fs::file_size(path));
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  const std::size_t got = file == nullptr ? 0 : std::fread(bytes.data(), 1, bytes.size(), file);
  if (file != nullptr) std::fclose(file);
  if (got != bytes.size()) throw std::runtime_error(path.string() + ": cannot be read");
  return bytes;
}

// Numbers with a point or an exponent as floats, others as integers; returns their sum, so that
// the work is not left out.
double parse_numbers(const std::vector<char>& bytes) {
  double sum = 0.0;
  const char* const end = bytes.data() + bytes.size();
  for (const char* at = bytes.data(); at != end;) {
    if (*at != '-' && (*at < '0' || *at > '9')) {
      ++at;
      continue;
    }
    std::uint32_t integer = 0;
    auto result = std::from_chars(at, end, integer);
    if (result.ec == std::errc() && (result.ptr == end || *result.ptr == ' ' || *result.ptr == '\n')) {
      sum += integer;
    } else {
      float value = 0.0f;
      result = std::from_chars(at, end, value);
      sum += static_cast<double>(value);
    }
    at = std::max(result.ptr, at + 1);
  }
  return sum;
}

void run(std::size_t triangles, const fs::path& folder) {
  const TriangleMesh mesh = builtin_scene("terrain:" + std::to_string(triangles)).mesh;
  std::cout << bench::machine_name() << "; " << bench::compiler_name() << "; " << mesh.triangles.size()
            << " triangles, medians of " << kRounds << " interleaved rounds, one thread, load "
            << bench::machine_load() << ".\n\n"
            << "| format | MB | load s | million triangles/s | read s | read and from_chars s | "
               "load's speed against it |\n|---|---|---|---|---|---|---|\n";
  for (const Format& format : kFormats) {
    const fs::path path = folder / ("plumb_files_bench." + std::string(format.extension));
    {
      Writer out(path);
      format.write(out, mesh);
    }
    if (!same_mesh(load_mesh(path), mesh, format.indexed)) {
      throw std::runtime_error(path.string() + ": what is loaded is not what was written");
    }
    double sum = 0.0;
    const std::vector<double> seconds =
        bench::time_interleaved({[&] { sum += static_cast<double>(load_mesh(path).positions.size()); },
                                 [&] { sum += read_bytes(path).front(); },
                                 [&] {
                                   const std::vector<char> bytes = read_bytes(path);
                                   sum += format.text ? parse_numbers(bytes) : bytes.front();
                                 }},
                                kRounds, 1);
    if (!std::isfinite(sum)) throw std::runtime_error("the sum of a terrain's numbers is not finite");
    std::printf("| %s | %.0f | %.2f | %.1f | %.2f | %.2f | %.2f |\n", format.name,
                static_cast<double>(fs::file_size(path)) * 1e-6, seconds[0],
                static_cast<double>(mesh.triangles.size()) * 1e-6 / seconds[0], seconds[1], seconds[2],
                seconds[2] / seconds[0]);
    std::fflush(stdout);
    fs::remove(path);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::size_t triangles = 10'000'000;
    if (argc > 1) {
      const char* const end = argv[1] + std::strlen(argv[1]);
      const auto [stop, error] = std::from_chars(argv[1], end, triangles);
      if (error != std::errc() || stop != end || argc > 3) {
        std::cerr << "usage: plumb_files_bench [TRIANGLES] [FOLDER]\n";
        return 2;
      }
    }
    run(triangles, argc > 2 ? fs::path(argv[2]) : fs::temp_directory_path());
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  return 0;
}
