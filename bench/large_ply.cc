// Writes a scene that is large on purpose, to measure streams with (docs/performance.md).
//
//     plumb_large_ply TRIANGLES FOLDER [FILES] [shuffled]
//
// The built-in terrain of about so many triangles as FOLDER/terrain-1.ply and so on, binary, its triangles in
// order over FILES files (1 unless said), each with the vertices between the first and the last that it uses;
// or, shuffled, in an order at random. The scene is in memory while it is written.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "plumb/builtin.h"

namespace {

using namespace plumb;
namespace fs = std::filesystem;

void write_ply(const fs::path& path, MeshView mesh, std::uint32_t first_vertex) {
  std::ofstream out(path, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  out.write(reinterpret_cast<const char*>(mesh.positions.data()),
            static_cast<std::streamsize>(mesh.positions.size_bytes()));
  constexpr std::size_t kRow = 13, kRows = 1 << 16;
  std::vector<char> rows(kRow * kRows);
  for (std::size_t first = 0; first < mesh.triangles.size(); first += kRows) {
    const std::size_t count = std::min(kRows, mesh.triangles.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::uvec3 corners = mesh.triangles[first + i] - first_vertex;
      rows[i * kRow] = 3;
      std::memcpy(&rows[i * kRow + 1], &corners, sizeof(corners));
    }
    out.write(rows.data(), static_cast<std::streamsize>(count * kRow));
  }
  if (!out.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

void write_files(const TriangleMesh& mesh, const fs::path& folder, std::size_t files) {
  for (std::size_t file = 0; file < files; ++file) {
    const std::size_t first = mesh.triangles.size() * file / files;
    const std::size_t end = mesh.triangles.size() * (file + 1) / files;
    const auto triangles = std::span(mesh.triangles).subspan(first, end - first);
    std::uint32_t least = 0xffffffffu, greatest = 0;
    for (const glm::uvec3& t : triangles) {
      least = std::min({least, t.x, t.y, t.z});
      greatest = std::max({greatest, t.x, t.y, t.z});
    }
    const fs::path path = folder / ("terrain-" + std::to_string(file + 1) + ".ply");
    const MeshView part(std::span(mesh.positions).subspan(least, greatest - least + 1), triangles);
    write_ply(path, part, least);
    std::cout << path.string() << ": " << part.triangles.size() << " triangles, " << part.positions.size()
              << " vertices, " << fs::file_size(path) << " bytes\n";
  }
}

int run(std::span<char*> arguments) {
  if (arguments.size() < 3)
    throw std::runtime_error("usage: plumb_large_ply TRIANGLES FOLDER [FILES] [shuffled]");
  TriangleMesh mesh = builtin_scene("terrain:" + std::string(arguments[1])).mesh;
  const std::size_t files = arguments.size() > 3 ? std::stoul(arguments[3]) : 1;
  if (files == 0) throw std::runtime_error("FILES is 0");
  if (arguments.size() > 4) {
    std::mt19937_64 random(1);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  }
  write_files(mesh, arguments[2], files);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(std::span(argv, static_cast<std::size_t>(argc)));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
