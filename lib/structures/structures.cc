#include "plumb/structures.h"

#include <string>

#include "plumb/brute_force.h"
#include "plumb/error.h"
#include "plumb/kd_tree.h"
#include "plumb/octree.h"
#include "plumb/sphere_tree.h"
#include "plumb/uniform_grid.h"

namespace plumb {
namespace {

Structure build_bvh(MeshView mesh, const StructureSettings& settings) {
  BuildOptions options;
  options.quality = settings.quality;
  options.width = settings.width;
  options.threads = settings.threads;
  options.simd = settings.simd;
  options.first_id = settings.first_id;
  options.progress = settings.progress;
  return Bvh(mesh, options);
}

struct Entry {
  StructureKind kind;
  std::string_view name;
  Structure (*build)(MeshView mesh, const StructureSettings& settings);
};

constexpr Entry kEntries[] = {
    {StructureKind::Bvh, "bvh", build_bvh},
    {StructureKind::BruteForce, "brute",
     [](MeshView mesh, const StructureSettings& s) -> Structure {
       return BruteForce(mesh, {.simd = s.simd, .first_id = s.first_id});
     }},
    {StructureKind::KdTree, "kdtree",
     [](MeshView mesh, const StructureSettings& s) -> Structure {
       return KdTree(mesh,
                     {.threads = s.threads, .simd = s.simd, .first_id = s.first_id, .progress = s.progress});
     }},
    {StructureKind::UniformGrid, "grid",
     [](MeshView mesh, const StructureSettings& s) -> Structure {
       return UniformGrid(mesh, {.cells_per_triangle = s.cells_per_triangle,
                                 .threads = s.threads,
                                 .simd = s.simd,
                                 .first_id = s.first_id,
                                 .progress = s.progress});
     }},
    {StructureKind::Octree, "octree",
     [](MeshView mesh, const StructureSettings& s) -> Structure {
       return Octree(mesh,
                     {.threads = s.threads, .simd = s.simd, .first_id = s.first_id, .progress = s.progress});
     }},
    {StructureKind::SphereTree, "spheres",
     [](MeshView mesh, const StructureSettings& s) -> Structure {
       return SphereTree(mesh, {.threads = s.threads, .first_id = s.first_id, .progress = s.progress});
     }},
};

const Entry& entry_of(StructureKind kind) {
  for (const Entry& entry : kEntries) {
    if (entry.kind == kind) return entry;
  }
  throw Error("plumb: StructureKind " + std::to_string(static_cast<int>(kind)) +
              " is none of its enumerators");
}

}  // namespace

Structure build_structure(MeshView mesh, const StructureSettings& settings) {
  return entry_of(settings.kind).build(mesh, settings);
}

std::vector<StructureKind> structure_kinds() {
  std::vector<StructureKind> kinds;
  for (const Entry& entry : kEntries) kinds.push_back(entry.kind);
  return kinds;
}

std::string_view structure_kind_name(StructureKind kind) { return entry_of(kind).name; }

}  // namespace plumb
