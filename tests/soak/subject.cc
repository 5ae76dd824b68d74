#include "soak/subject.h"

#include <utility>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/kd_tree.h"
#include "plumb/octree.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "plumb/sphere_tree.h"
#include "plumb/uniform_grid.h"

namespace plumb::soak {
namespace {

template <typename Inner>
class Adapted final : public Structure {
 public:
  explicit Adapted(Inner inner) : inner_(std::move(inner)) {}
  Hit closest(const Ray& ray) const override { return inner_.closest(ray); }
  bool any(const Ray& ray) const override { return inner_.any(ray); }
  void all(const Ray& ray, std::vector<Hit>& hits) const override { inner_.all(ray, hits); }
  std::size_t first(const Ray& ray, std::span<Hit> hits) const override { return inner_.first(ray, hits); }
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const override { inner_.closest(rays, hits); }
  void any(std::span<const Ray> rays, std::span<bool> hits) const override { inner_.any(rays, hits); }
  void cast(const Camera& camera, Frame& frame) const override {
    CastOptions options;
    options.threads = 1;
    options.method = CastMethod::Rays;
    plumb::cast(inner_, camera, frame, options);
  }

 private:
  Inner inner_;
};

Subject tree(int width, Simd simd, bool scalar, Quality quality, bool compact = false) {
  constexpr const char* kName[] = {"-fast-build", "", "-best-build"};
  constexpr const char* kField[] = {".quality = Quality::Fast, ", "", ".quality = Quality::Best, "};
  const auto index = static_cast<std::size_t>(quality);
  BuildOptions options;
  options.quality = quality;
  options.compact = compact;
  options.width = width;
  options.threads = 1;
  options.simd = simd;
  const std::string target(simd_name(simd));
  return {"bvh" + std::to_string(width) + kName[index] + (compact ? "-compact" : "") +
              (scalar ? "" : " " + target),
          std::string("Bvh(mesh, {") + kField[index] + ".width = " + std::to_string(width) +
              ", .simd = parse_simd(\"" + target + "\")" + (compact ? ", .compact = true})" : "})"),
          [options](const TriangleMesh& mesh) { return std::make_unique<Adapted<Bvh>>(Bvh(mesh, options)); },
          nullptr};
}

Subject brute_force(Simd simd) {
  const std::string target(simd_name(simd));
  return {"brute " + target, "BruteForce(mesh, {.simd = parse_simd(\"" + target + "\")})",
          [simd](const TriangleMesh& mesh) {
            return std::make_unique<Adapted<BruteForce>>(BruteForce(mesh, {.simd = simd}));
          },
          nullptr};
}

// One of the structures of cells.
template <typename Inner>
Subject cells(const std::string& method, const std::string& type, Simd simd) {
  const std::string target(simd_name(simd));
  return {method + " " + target, type + "(mesh, {.simd = parse_simd(\"" + target + "\")})",
          [simd](const TriangleMesh& mesh) {
            return std::make_unique<Adapted<Inner>>(Inner(mesh, {.threads = 1, .simd = simd}));
          },
          nullptr};
}

Subject spheres() {
  return {"spheres", "SphereTree(mesh)",
          [](const TriangleMesh& mesh) {
            return std::make_unique<Adapted<SphereTree>>(SphereTree(mesh, {.threads = 1}));
          },
          nullptr};
}

Subject tile_caster(int width, Simd simd) {
  const std::string target(simd_name(simd));
  return {"tile" + std::to_string(width) + " " + target,
          "cast(Bvh(mesh, {.width = " + std::to_string(width) + ", .simd = parse_simd(\"" + target +
              "\")}), camera, frame, {.method = CastMethod::Tiles})",
          nullptr, [width, simd](const TriangleMesh& mesh, const Camera& camera, Frame& frame) {
            BuildOptions build;
            build.width = width;
            build.threads = 1;
            build.simd = simd;
            CastOptions options;
            options.threads = 1;
            options.method = CastMethod::Tiles;
            plumb::cast(Bvh(mesh, build), camera, frame, options);
          }};
}

Subject rasterizer(Simd simd) {
  RasterOptions options;
  options.threads = 1;
  options.simd = simd;
  const std::string target(simd_name(simd));
  return {"raster " + target, "rasterize(mesh, camera, frame, {.simd = parse_simd(\"" + target + "\")})",
          nullptr, [options](const TriangleMesh& mesh, const Camera& camera, Frame& frame) {
            rasterize(mesh, camera, frame, options);
          }};
}

}  // namespace

std::vector<Subject> all_subjects() {
  std::vector<Subject> subjects;
  for (const Simd simd : simd_targets()) subjects.push_back(brute_force(simd));
  subjects.push_back(tree(2, simd_targets().front(), true, Quality::Balanced));
  subjects.push_back(spheres());
  for (const int width : {4, 8}) {
    for (const Simd simd : simd_targets()) subjects.push_back(tree(width, simd, false, Quality::Balanced));
    for (const Quality quality : {Quality::Fast, Quality::Best}) {
      subjects.push_back(tree(width, simd_targets().front(), false, quality));
    }
  }
  for (const Simd simd : simd_targets()) subjects.push_back(tree(8, simd, false, Quality::Balanced, true));
  for (const Simd simd : simd_targets()) {
    subjects.push_back(cells<KdTree>("kdtree", "KdTree", simd));
    subjects.push_back(cells<UniformGrid>("grid", "UniformGrid", simd));
    subjects.push_back(cells<Octree>("octree", "Octree", simd));
  }
  for (const int width : {4, 8}) {
    for (const Simd simd : simd_targets()) subjects.push_back(tile_caster(width, simd));
  }
  for (const Simd simd : simd_targets()) subjects.push_back(rasterizer(simd));
  return subjects;
}

}  // namespace plumb::soak
