#pragma once

#include <string>
#include <vector>

#include "task.h"

namespace plumb::bench {

/// Embree on the same rays: its 1, 4, 8 and 16 wide calls on scenes of medium and high build quality, two of
/// them robust as well, and the builds of low, medium and high quality. Empty where it is not installed.
std::vector<Task> embree_tasks(const Context& context);

/// "Embree 3.13.5"; empty where it is not installed.
std::string embree_version();

/// The method whose speed the others' are compared with: its single-ray call, fast.
inline constexpr const char* kEmbreeBaseline = "embree-fast-1";

}  // namespace plumb::bench
