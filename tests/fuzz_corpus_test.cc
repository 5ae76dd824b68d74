#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/instance.h"
#include "fuzz/targets.h"
#include "plumb/brute_force.h"

// What the fuzzers begin with, and whatever made one fail, without Clang and without chance.

using namespace plumb;

namespace {

struct Input {
  std::string name, bytes;
};

std::vector<Input> corpus(const std::string& folder) {
  std::vector<Input> inputs;
  for (const auto& file : std::filesystem::directory_iterator(PLUMB_FUZZ_CORPUS + folder)) {
    std::ifstream in(file.path(), std::ios::binary);
    inputs.push_back({file.path().filename().string(), {std::istreambuf_iterator<char>(in), {}}});
  }
  return inputs;
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

TEST_SUITE("fuzz corpus") {
  TEST_CASE("every mesh file is read or refused as promised, and some of each format are read") {
    for (const std::string format : {"ply", "obj", "stl", "off"}) {
      int read = 0;
      for (const Input& input : corpus(format)) {
        CAPTURE(format);
        CAPTURE(input.name);
        bool loaded = false;
        CHECK(fuzz::fault_of_reader("." + format, input.bytes, &loaded) == "");
        read += loaded ? 1 : 0;
      }
      CHECK(read > 0);
    }
  }

  TEST_CASE("every method answers every scene as exact arithmetic does, and something is seen") {
    std::size_t hits = 0, frames = 0;
    for (const Input& input : corpus("methods")) {
      CAPTURE(input.name);
      CHECK(fuzz::fault_of_methods(bytes_of(input.bytes)) == "");
      const cases::Instance instance = fuzz::instance_of(bytes_of(input.bytes));
      frames += instance.camera ? 1 : 0;
      for (const Ray& ray : instance.rays) hits += BruteForce(instance.mesh).any(ray) ? 1 : 0;
    }
    CHECK(hits > 2);
    CHECK(frames > 1);
  }

  TEST_CASE("any bytes make a scene whose indices are in range") {
    for (int length = 0; length < 300; ++length) {
      for (const char byte : {'\0', '\1', '\2', '\3', '\310', '\377'}) {
        const cases::Instance instance =
            fuzz::instance_of(bytes_of(std::string(static_cast<std::size_t>(length), byte)));
        for (const glm::uvec3& t : instance.mesh.triangles) {
          for (int k = 0; k < 3; ++k) REQUIRE(t[k] < instance.mesh.positions.size());
        }
      }
    }
  }
}
