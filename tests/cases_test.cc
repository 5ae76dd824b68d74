#include <doctest/doctest.h>

#include <cstddef>
#include <cstring>
#include <set>
#include <string_view>
#include <vector>

#include "cases/cases.h"
#include "cases_util.h"

// The library of hard cases as a whole. What each case claims to be is in the other files.

using namespace plumb;
using cases::Instance;

namespace {

// FNV-1a over the bits, so that -0 and NaNs count as they are.
class Hash {
 public:
  template <typename T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3u;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::uint64_t hash(const Instance& instance) {
  Hash hash;
  for (const glm::vec3& v : instance.mesh.positions) hash.add(v);
  for (const glm::uvec3& t : instance.mesh.triangles) hash.add(t);
  for (const Ray& ray : instance.rays) hash.add(ray);
  for (const Ray& ray : cases::pixel_rays(instance)) hash.add(ray);
  return hash.value();
}

}  // namespace

TEST_CASE("cases: every case has its own name and says how it is built and what is defined") {
  std::set<std::string_view> names;
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    CHECK(names.insert(c.name).second);
    CHECK(cases::find_case(c.name) == &c);
    CHECK(c.built.ends_with('.'));
    CHECK(c.definition.ends_with('.'));
    CHECK(c.cost >= 1);
  }
  CHECK(cases::find_case("none of them") == nullptr);
}

TEST_CASE("cases: an instance is made from the case, the seed and its index alone") {
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    const std::uint64_t made = hash(cases::make_instance(c, 1, 5));
    CHECK(hash(cases::make_instance(c, 1, 5)) == made);
    if (c.name == "no-triangle") continue;
    CHECK(hash(cases::make_instance(c, 1, 6)) != made);
    CHECK(hash(cases::make_instance(c, 2, 5)) != made);
  }
}

TEST_CASE("cases: every instance has something to look with, and indices in range") {
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    cases::each_instance(c.name, 20, [&](const Instance& instance) {
      CHECK((!instance.rays.empty() || instance.camera.has_value()));
      std::size_t beyond = 0;
      for (const glm::uvec3& t : instance.mesh.triangles) {
        for (int i = 0; i < 3; ++i) beyond += t[i] < instance.mesh.positions.size() ? 0 : 1;
      }
      CHECK(beyond == 0);
    });
  }
}

TEST_CASE("cases: something is seen in all but those that are about seeing nothing") {
  const std::set<std::string_view> all_missed = {"non-finite-ray", "no-triangle"};
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    bool seen = false;
    cases::each_instance(c.name, 20, [&](const Instance& instance) {
      if (seen) return;
      for (const Ray& ray : instance.rays) seen = seen || cases::is_hit(instance, ray);
      if (seen || !instance.camera) return;
      for (const Ray& ray : cases::pixel_rays(instance)) seen = seen || cases::is_hit(instance, ray);
    });
    CHECK(seen != all_missed.contains(c.name));
  }
}
