#include "build/tree_parts.h"

#include <cstddef>
#include <cstdint>

#include "build/chunks.h"

namespace plumb::detail {
namespace {

// Where a part's nodes go: its root to `root`, the others from `rest` on.
struct Place {
  const TreePart* part;
  std::size_t root, rest;
};

// Appends the places of a part and all below it; returns where the next node goes.
std::size_t place(const TreePart& part, std::size_t root, std::size_t rest, std::vector<Place>& places) {
  places.push_back({&part, root, rest});
  if (part.child[0] == nullptr) return rest + part.nodes.size() - 1;
  const std::size_t next = place(*part.child[0], rest, rest + 2, places);
  return place(*part.child[1], rest + 1, next, places);
}

void copy_part(const Place& place, std::vector<BinaryNode>& nodes) {
  const TreePart& part = *place.part;
  if (part.child[0] != nullptr) {
    nodes[place.root] = {part.box, static_cast<std::uint32_t>(place.rest), 0};
    return;
  }
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    BinaryNode node = part.nodes[i];
    if (node.count == 0) node.first += static_cast<std::uint32_t>(place.rest - 1);
    nodes[i == 0 ? place.root : place.rest + i - 1] = node;
  }
}

}  // namespace

std::vector<BinaryNode> join_parts(const TreePart& root) {
  std::vector<Place> places;
  std::vector<BinaryNode> nodes(place(root, 0, 1, places));
  for_pieces(places.size(), piece_count(places.size(), 4),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) copy_part(places[i], nodes);
             });
  return nodes;
}

}  // namespace plumb::detail
