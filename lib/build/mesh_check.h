#pragma once

#include <cstdint>

#include "plumb/mesh.h"

namespace plumb::detail {

/// What must hold of a mesh before anything reads it: every index is below the number of positions,
/// and every id, `first_id` plus the triangle's index, below kNone. Throws plumb::Error naming what is
/// at fault; `who` is the public name that was called.
void check_mesh(MeshView mesh, std::uint32_t first_id, const char* who);

}  // namespace plumb::detail
