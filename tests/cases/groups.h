#pragma once

#include <span>

#include "cases/cases.h"

// The groups, a file each.

namespace plumb::cases {

std::span<const Case> edge_cases();
std::span<const Case> plane_cases();
std::span<const Case> shape_cases();
std::span<const Case> range_cases();
std::span<const Case> depth_cases();
std::span<const Case> coincident_cases();
std::span<const Case> origin_cases();
std::span<const Case> far_cases();
std::span<const Case> tree_cases();
std::span<const Case> anything_cases();

}  // namespace plumb::cases
