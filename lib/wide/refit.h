#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/mesh.h"
#include "wide/wide_tree.h"

namespace plumb::detail {

/// What a wide tree's boxes and triangles sum to.
struct TreeAreas {
  double tests = 0;  ///< of the nodes' boxes, each as often as it has children, and of the leaves', as often
                     ///< as they have triangles: the surface area heuristic's cost but for the root's area
  double triangles = 0;    ///< of the triangles' own boxes
  std::size_t unseen = 0;  ///< references to triangles with a NaN or infinite coordinate

  /// Tests for each time that a triangle's own box would be met; does not change when all of the scene is
  /// moved or scaled. 0 when no triangle has an area.
  double looseness() const { return triangles > 0.0 ? tests / triangles : 0.0; }
};

/// The areas as they are.
template <int W>
TreeAreas tree_areas(const WideTree<W>& tree);

/// Takes the triangles' coordinates anew from a mesh of as many triangles, and makes all boxes fit, from the
/// leaves up. Triangles that are not finite any more stay as points that no ray meets and no box holds. The
/// result does not depend on `threads`.
template <int W>
TreeAreas refit(WideTree<W>& tree, MeshView mesh, std::uint32_t first_id, int threads);

extern template TreeAreas tree_areas(const WideTree<4>&);
extern template TreeAreas tree_areas(const WideTree<8>&);
extern template TreeAreas refit(WideTree<4>&, MeshView, std::uint32_t, int);
extern template TreeAreas refit(WideTree<8>&, MeshView, std::uint32_t, int);

}  // namespace plumb::detail
