#include "llvmpipe_peer.h"

namespace plumb::bench {

void set_llvmpipe_threads(int) {}
std::vector<Task> llvmpipe_tasks(const Context&) { return {}; }
std::string llvmpipe_version() { return ""; }

}  // namespace plumb::bench
