#pragma once

#include <plumb/frame.h>
#include <plumb/mesh.h>

/// Whether the rays and the rasterizer see the same in every pixel of a small frame.
bool sees_the_same(const plumb::TriangleMesh& mesh);
