// Embree is not installed: no peer.

#include "embree_peer.h"

namespace plumb::bench {

std::vector<Task> embree_tasks(const Context&) { return {}; }
std::string embree_version() { return ""; }

}  // namespace plumb::bench
