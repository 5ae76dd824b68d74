#pragma once

#include <string>
#include <vector>

#include "task.h"

namespace plumb::bench {

/// Says how many threads llvmpipe draws with in this process; before anything of it is asked. 1 is the
/// calling thread alone.
void set_llvmpipe_threads(int threads);

/// Its frame of a view, read-back left out; none where it is not on this machine, or for another number of
/// threads than was set.
std::vector<Task> llvmpipe_tasks(const Context& context);

/// What it calls itself; empty where it is not there.
std::string llvmpipe_version();

}  // namespace plumb::bench
