#include <doctest/doctest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <random>
#include <string>

#include "io_util.h"
#include "mesh_files.h"
#include "plumb/builtin.h"
#include "plumb/stream.h"

// What streaming holds, counted by every allocation of this program.

namespace {

std::atomic<std::size_t> held = 0, most = 0;

void* allocate(std::size_t bytes) {
  void* memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = held += malloc_usable_size(memory);
  std::size_t before = most;
  while (before < now && !most.compare_exchange_weak(before, now)) {
  }
  return memory;
}

void release(void* memory) {
  if (memory == nullptr) return;
  held -= malloc_usable_size(memory);
  std::free(memory);
}

// The most that is held while `work` runs, over what was before.
template <typename Work>
std::size_t most_during(const Work& work) {
  const std::size_t before = held;
  most = before;
  work();
  return most - before;
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes); }
void* operator new[](std::size_t bytes) { return allocate(bytes); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }

using namespace plumb;
using namespace plumb::test;

namespace {

void check_memory(const std::filesystem::path& path) {
  CAPTURE(path.string());
  const std::size_t whole = most_during([&] { load_mesh(path); });
  for (const std::size_t memory : {std::size_t{1} << 20, std::size_t{3} << 20}) {
    StreamOptions options;
    options.memory_bytes = memory;
    const std::size_t streamed = most_during([&] {
      stream_mesh(
          path, [](MeshView, std::uint32_t) {}, options);
    });
    CHECK(streamed <= memory);
    CHECK(streamed > memory / 2);  // what may be held is made use of
    CHECK(whole > 2 * memory);
  }
}

}  // namespace

TEST_SUITE("streams: memory") {
  TEST_CASE("streaming holds no more than it may, whatever the file") {
    const TempDir dir;
    TriangleMesh mesh = builtin_scene("terrain:200000").mesh;
    for (const std::string& format : kPlyFormats) check_memory(dir.write("a.ply", make_ply_of(mesh, format)));
    check_memory(dir.write("faces_first.ply", make_ply_of(mesh, kPlyFormats.at(1), true)));
    check_memory(dir.write("a.obj", make_obj(mesh, ObjOrder::Mixed)));
    check_memory(dir.write("a.off", make_off(mesh)));
    check_memory(dir.write("text.stl", make_stl_text(mesh)));
    check_memory(dir.write("binary.stl", make_stl_binary(mesh)));
    std::mt19937_64 random(3);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    check_memory(dir.write("shuffled.ply", make_ply_of(mesh, kPlyFormats.at(1))));
    check_memory(dir.write("shuffled.off", make_off(mesh)));
  }

  TEST_CASE("a header that is too long for the memory is refused, and is not held") {
    const TempDir dir;
    std::string header = "ply\nformat ascii 1.0\n";
    for (int i = 0; i < 100000; ++i) header += "comment a line of many\n";
    const auto path = dir.write("a.ply", header + "end_header\n");
    CHECK(load_mesh(path).triangles.empty());
    StreamOptions options;
    options.memory_bytes = std::size_t{1} << 20;
    std::string error;
    const std::size_t streamed = most_during([&] {
      error = error_of([&] {
        stream_mesh(
            path, [](MeshView, std::uint32_t) {}, options);
      });
    });
    CHECK(contains(error, "a.ply: byte 262144: the header goes on; it is too long"));
    CHECK(streamed <= options.memory_bytes);
  }
}
