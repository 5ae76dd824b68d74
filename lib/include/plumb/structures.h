#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "plumb/bvh.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// The ways to make a scene ready for rays. docs/structures.md compares them.
enum class StructureKind {
  Bvh,          ///< Bvh: the one to take unless something speaks for another
  BruteForce,   ///< BruteForce: for a handful of triangles
  KdTree,       ///< KdTree: of the most tests, few; slow to build
  UniformGrid,  ///< UniformGrid: the quickest to build
  Octree,       ///< Octree: between the two
  SphereTree,   ///< SphereTree: to compare volumes with
};

/// What builds a structure of any kind. Each kind takes what it knows and ignores the rest.
struct StructureSettings {
  StructureKind kind = StructureKind::Bvh;  ///< see there
  /// Of a Bvh: as BuildOptions::quality and BuildOptions::width.
  Quality quality = Quality::Balanced;
  int width = 0;  ///< see quality
  /// Of a UniformGrid: as UniformGridOptions::cells_per_triangle.
  double cells_per_triangle = 1.0;
  /// Threads for the build; 0 takes all that the affinity mask allows.
  int threads = 0;
  /// Instruction set of the queries; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle.
  std::uint32_t first_id = 0;
  /// As BuildOptions::progress.
  std::function<bool(double)> progress = nullptr;
};

/// Builds it. Throws what the kind's constructor throws, and plumb::Error for a kind that is none.
Structure build_structure(MeshView mesh, const StructureSettings& settings = {});

/// All kinds, in the order of their enumerators.
std::vector<StructureKind> structure_kinds();

/// The name of a kind, as the tool's `--methods` has it; a Bvh's has its width behind it there.
std::string_view structure_kind_name(StructureKind kind);

}  // namespace plumb
