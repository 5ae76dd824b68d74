#pragma once

// Every public header of plumb. Link what you call: plumb::plumb, plumb::raster, plumb::io.
#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/camera.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/frame.h"
#include "plumb/io.h"
#include "plumb/mesh.h"
#include "plumb/raster.h"
#include "plumb/ray.h"
#include "plumb/simd.h"
#include "plumb/surface.h"
#include "plumb/version.h"
