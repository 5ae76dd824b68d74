#include "wide/compact_tree.h"

#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "build/chunks.h"
#include "plumb/error.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 1024;  // blocks

// Loads of a whole register from a block's positions end before this many bytes after it.
constexpr std::size_t kSlackUnits = 8;

// The vertices of a block's first lanes, each once, and which of them each corner is.
template <int W>
struct Vertices {
  using Bits = std::array<std::uint32_t, 3>;
  std::array<Bits, 3 * W> vertex;
  std::array<std::array<unsigned char, W>, 3> corner{};
  std::size_t count = 0;

  Vertices(const TriangleBlock<W>& block, std::size_t triangles) {
    for (std::size_t lane = 0; lane < triangles; ++lane) {
      for (std::size_t v = 0; v < 3; ++v) {
        Bits bits;
        for (std::size_t axis = 0; axis < 3; ++axis)
          bits[axis] = std::bit_cast<std::uint32_t>(block.vertex[v][axis][lane]);
        corner[v][lane] = static_cast<unsigned char>(place_of(bits));
      }
    }
  }

 private:
  std::size_t place_of(const Bits& bits) {
    // By their bits: 0 and -0 are the same place but not the same input.
    std::size_t i = 0;
    while (i < count && vertex[i] != bits) ++i;
    if (i == count) vertex[count++] = bits;
    return i;
  }
};

template <int W>
void write(const TriangleBlock<W>& block, const Vertices<W>& vertices, CompactUnit* units) {
  using Layout = CompactLayout<W>;
  std::array<unsigned char, sizeof(CompactUnit) * 64> bytes{};
  static_assert(Layout::kPosition + 12 * (3 * W) <= sizeof bytes);
  std::memcpy(bytes.data(), vertices.corner.data(), 3 * W);
  bytes[Layout::kVertices] = static_cast<unsigned char>(vertices.count);
  std::memcpy(bytes.data() + Layout::kId, block.id, sizeof block.id);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < vertices.count; ++i) {
      std::memcpy(bytes.data() + Layout::kPosition + 4 * (axis * vertices.count + i),
                  &vertices.vertex[i][axis], 4);
    }
  }
  std::memcpy(units, bytes.data(), Layout::units(vertices.count) * sizeof(CompactUnit));
}

}  // namespace

void sum_units(std::span<std::uint32_t> units) {
  std::uint64_t sum = 0;
  for (std::uint32_t& unit : units) {
    sum += unit;
    if (sum > 0xffffffffu) {
      throw Error(
          "plumb: the leaves of a compact tree of this mesh would take 64 GiB and more; split the mesh, or "
          "build without BuildOptions::compact");
    }
    unit = static_cast<std::uint32_t>(sum);
  }
}

template <int W>
CompactTree<W> compact(WideTree<W> tree, int threads) {
  // How many triangles a block holds is in the node above it.
  std::vector<unsigned char> triangles(tree.blocks.size());
  for (const WideNode<W>& node : tree.nodes) {
    for (int i = 0; i < W; ++i) {
      for (std::uint32_t first = 0; first < node.count[i]; first += W) {
        triangles[node.child[i] + first / W] =
            static_cast<unsigned char>(std::min<std::uint32_t>(node.count[i] - first, W));
      }
    }
  }
  // The unit at which each block begins, and the end.
  std::vector<std::uint32_t> place(tree.blocks.size() + 1);
  CompactTree<W> packed;
  in_arena(threads, [&] {
    const std::size_t pieces = piece_count(tree.blocks.size(), kPieceSize);
    for_pieces(tree.blocks.size(), pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        place[i + 1] = static_cast<std::uint32_t>(
            CompactLayout<W>::units(Vertices<W>(tree.blocks[i], triangles[i]).count));
      }
    });
    sum_units(place);
    const std::size_t last = place.back();
    packed.units.resize(last + kSlackUnits);
    std::memset(static_cast<void*>(packed.units.data() + last), 0, kSlackUnits * sizeof(CompactUnit));
    for_pieces(tree.blocks.size(), pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        write(tree.blocks[i], Vertices<W>(tree.blocks[i], triangles[i]), packed.units.data() + place[i]);
      }
    });
  });
  for (WideNode<W>& node : tree.nodes) {
    for (int i = 0; i < W; ++i) {
      if (node.count[i] != 0) node.child[i] = place[node.child[i]];
    }
  }
  packed.nodes = std::move(tree.nodes);
  packed.box = tree.box;
  packed.greatest = tree.greatest;
  return packed;
}

template CompactTree<8> compact(WideTree<8>, int);

}  // namespace plumb::detail
