#pragma once

#include <vector>

#include "plumb/simd.h"
#include "task.h"

namespace plumb::bench {

/// Everything plumb can do at a view: trees of each width and arithmetic through the span calls and `cast`,
/// the rasterizer, and the builds; each for each of the instruction sets.
std::vector<Task> our_tasks(const Context& context, const std::vector<Simd>& targets);

}  // namespace plumb::bench
