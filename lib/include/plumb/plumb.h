#pragma once

// Every public header of plumb. Link what you call: plumb::plumb, plumb::raster, plumb::io.

/// @namespace plumb
/// What does this ray, this camera, see? Every way to ask gives the same bits.
///
/// Every function reports bad input by throwing plumb::Error, and running out of memory by what the
/// standard library throws (load_mesh() by plumb::Error). None prints, exits, keeps global state or needs a
/// call to start up. All const calls are safe from many threads. The caller's floating-point mode
/// (flush-to-zero, denormals-are-zero, rounding direction) changes no answer and is the same afterwards.

/// @mainpage
/// A mesh (mesh.h, io.h, stream.h, builtin.h) is asked by rays (ray.h) through a structure (structure.h:
/// bvh.h, brute_force.h), one ray or many at a time; surface.h gives the point and normal of a hit. A camera
/// (camera.h) asks for a whole frame (frame.h), through a structure (cast.h) or by drawing triangles
/// (raster.h). Frames of both are equal to the bit, and compare() says so.
///
/// docs/visibility.md defines what is visible; docs/examples has programs to start from.

#include "plumb/advise.h"
#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/camera.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/frame.h"
#include "plumb/io.h"
#include "plumb/kd_tree.h"
#include "plumb/layers.h"
#include "plumb/mesh.h"
#include "plumb/octree.h"
#include "plumb/raster.h"
#include "plumb/ray.h"
#include "plumb/shadow_map.h"
#include "plumb/simd.h"
#include "plumb/sphere_tree.h"
#include "plumb/statistics.h"
#include "plumb/stream.h"
#include "plumb/structure.h"
#include "plumb/structures.h"
#include "plumb/surface.h"
#include "plumb/topology.h"
#include "plumb/uniform_grid.h"
#include "plumb/version.h"
#include "plumb/visible.h"
#include "plumb/visible_triangles.h"
