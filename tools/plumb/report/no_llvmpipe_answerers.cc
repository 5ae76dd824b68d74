// OSMesa's headers were not found: no peer.

#include "report/answerer.h"

namespace plumb::tool {

std::vector<Answerer> llvmpipe_answerers() { return {}; }

}  // namespace plumb::tool
