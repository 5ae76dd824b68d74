#pragma once

#include <span>

#include "cases/cases.h"

// The groups, a file each.

namespace plumb::cases {

std::span<const Case> edge_cases();

}  // namespace plumb::cases
