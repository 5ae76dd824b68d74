#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "plumb/camera.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"
#include "support/random.h"

// The library of hard cases: each is one way in which a ray, a triangle or a camera is hard to answer
// exactly, with as many instances as are asked for. `plumb report --hard`, `plumb soak` and the tests draw
// from it.

namespace plumb::cases {

/// One scene of a case and what looks at it.
struct Instance {
  TriangleMesh mesh;             ///< small, unless the case's cost says otherwise; maybe empty
  std::vector<Ray> rays;         ///< maybe none, where a camera is there
  std::optional<Camera> camera;  ///< where a frame can show the case; of a few hundred pixels
};

/// A way to be hard.
struct Case {
  std::string_view group;       ///< of cases alike, such as "edges and vertices"
  std::string_view name;        ///< unique; words in lower case joined by '-', such as "shared-edge"
  std::string_view built;       ///< how it is built: one sentence
  std::string_view definition;  ///< what docs/visibility.md says of it: one sentence
  /// How many instances of a small scene one of this case is worth in time, about; at least 1. Who wants
  /// the same effort for every case makes only that share of the instances.
  std::uint32_t cost;
  void (*make)(hard::Random&, Instance&);
};

/// All of them, group by group.
std::span<const Case> all_cases();

/// The case of that name; null where there is none.
const Case* find_case(std::string_view name);

/// Instance `index` of a case: the same bits for the same seed on every machine and with every compiler,
/// whatever other cases there are and whichever instances were made before. Needs the default
/// floating-point mode.
Instance make_instance(const Case& hard_case, std::uint64_t seed, std::uint64_t index);

/// The rays of the instance's pixels, row by row; none without a camera.
std::vector<Ray> pixel_rays(const Instance& instance);

}  // namespace plumb::cases
