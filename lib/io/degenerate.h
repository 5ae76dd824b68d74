#pragma once

#include "exact/intersect.h"

namespace plumb::detail {

/// Whether the triangle's area is zero, exactly. Its coordinates are finite.
bool has_no_area(const Triangle& triangle);

}  // namespace plumb::detail
