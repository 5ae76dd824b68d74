#pragma once

#include <cstdint>
#include <string>

#include "cases/cases.h"

namespace plumb::soak {

/// An instance, and enough to make it again.
struct Drawn {
  std::string kind;  ///< the case, or the kind of scene
  std::string name;
  cases::Instance instance;
};

/// The `index`-th instance of an endless list that goes round all hard cases and, mixed at random, all kinds
/// of hard scenes, rays and cameras. The same on every machine. Needs the default floating-point mode.
Drawn draw_instance(std::uint64_t seed, std::uint64_t index);

}  // namespace plumb::soak
