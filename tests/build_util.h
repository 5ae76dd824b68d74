#pragma once

#include <string>
#include <vector>

#include "base/parallel.h"
#include "build/binned_sah.h"
#include "plumb/mesh.h"

namespace build_scenes {

inline plumb::detail::BinaryTree build(const plumb::TriangleMesh& mesh,
                                       const plumb::detail::BinnedSahOptions& options = {}) {
  plumb::detail::Progress progress(nullptr, mesh.triangles.size());
  return plumb::detail::build_binned_sah(mesh, options, progress);
}

/// What a check returns as one text; empty when all holds.
inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "; ";
  return text;
}

}  // namespace build_scenes
