#pragma once

#include <cstddef>

#include "plumb/builtin.h"
#include "plumb/mesh.h"

// One function a scene; builtin.cc holds their names, default sizes and ranges. Callers hold the
// default floating-point mode.

namespace plumb::detail {

/// `size` is about the number of triangles.
inline constexpr std::size_t kTeapotInStadiumSize = 320'000;
BuiltinScene teapot_in_stadium(std::size_t size);

/// `size` is about the number of triangles.
BuiltinScene terrain(std::size_t size);

/// `size` is the number of columns of blocks.
BuiltinScene grid(std::size_t size);

/// `size` is about the number of triangles. The same for those below.
BuiltinScene grass(std::size_t size);
BuiltinScene soup(std::size_t size);
BuiltinScene spheres(std::size_t size);
BuiltinScene cornell(std::size_t size);
BuiltinScene ties(std::size_t size);

/// `size` is the number of layers.
BuiltinScene quads(std::size_t size);

/// Appends the stadium: pitch, stands with seats, roof, a plinth at the centre spot whose top is
/// kPlinthHeight above the pitch. y is up, lengths are metres, the pitch's centre is the origin.
/// `detail` scales the number of rows, seats and segments along each dimension; 1 gives real sizes.
inline constexpr double kPlinthHeight = 1.1;
void append_stadium(TriangleMesh& mesh, double detail);

}  // namespace plumb::detail
