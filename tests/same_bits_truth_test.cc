#include <doctest/doctest.h>

#include <string_view>
#include <vector>

#include "oracle/oracle.h"
#include "plumb/frame.h"
#include "same_bits/answers.h"
#include "same_bits/entries.h"
#include "same_bits/table.h"
#include "support/effort.h"
#include "support/oracle_adapter.h"

// That the table which every machine is held to is the definition's: the same hashes from the oracle.

using namespace plumb;
using same_bits::Entry;
using same_bits::Part;
using same_bits::Row;

namespace {

// The oracle with the queries of a structure.
class Oracle {
 public:
  explicit Oracle(const Part& part) : scene_(witness::to_oracle(part.mesh)) {}

  Hit closest(const Ray& ray) const { return witness::to_plumb(scene_.closest(witness::to_oracle(ray))); }
  bool any(const Ray& ray) const { return scene_.any(witness::to_oracle(ray)); }
  void all(const Ray& ray, std::vector<Hit>& hits) const {
    hits = witness::to_plumb(scene_.all(witness::to_oracle(ray)));
  }
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = closest(rays[i]);
  }
  void any(std::span<const Ray> rays, std::span<bool> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = any(rays[i]);
  }

 private:
  oracle::Scene scene_;
};

Frame oracle_frame(const Part& part, const Camera& camera) {
  return witness::oracle_frame(part.mesh, camera);
}

}  // namespace

TEST_SUITE("same bits") {
  TEST_CASE("the table is what exact arithmetic says") {
    const std::vector<Entry>& entries = same_bits::entries();
    REQUIRE(same_bits::table().size() == entries.size());
    for (std::size_t i = 0; i < entries.size(); i += hard::kEffortDivisor) {
      const Row& row = same_bits::table()[i];
      CAPTURE(row.name);
      REQUIRE(entries[i].name == row.name);
      CHECK(hash_of_rays(entries[i], [](const Part& part) { return Oracle(part); }) == row.rays);
      CHECK(hash_of_frames(entries[i], oracle_frame) == row.frames);
    }
  }
}
