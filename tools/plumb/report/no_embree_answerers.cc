// Embree was not found: no peer.

#include "report/answerer.h"

namespace plumb::tool {

std::vector<Answerer> embree_answerers() { return {}; }

}  // namespace plumb::tool
