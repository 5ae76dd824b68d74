#include "stream_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "plumb/error.h"
#include "plumb/raster.h"
#include "plumb/stream.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The box of what it was grown by.
struct Bounds {
  glm::vec3 least = glm::vec3(std::numeric_limits<float>::infinity());
  glm::vec3 greatest = glm::vec3(-std::numeric_limits<float>::infinity());

  void grow(const glm::vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      greatest[axis] = std::max(greatest[axis], p[axis]);
    }
  }
};

/// Finds faults of a file's beginning before anything else is done: begins to read it and stops.
void look_at(const std::string& file) {
  StreamOptions options;
  options.progress = [](double) { return false; };
  try {
    stream_mesh(
        file, [](MeshView, std::uint32_t) {}, options);
  } catch (const Cancelled&) {
  }
}

double bytes_of(const std::string& file) {
  std::error_code ignored;
  return static_cast<double>(fs::file_size(file, ignored));
}

}  // namespace

StreamScene::StreamScene(std::vector<std::string> files, std::size_t memory_bytes)
    : files_(std::move(files)), memory_bytes_(memory_bytes) {
  if (files_.empty()) throw Error("plumb: --stream: name the mesh files to draw");
  for (const std::string& file : files_) {
    if (is_builtin(file)) {
      throw Error(
          fmt::format("plumb: --stream {}: only mesh files are read in parts; leave out --stream", file));
    }
    look_at(file);
  }
}

StreamScene::Totals StreamScene::give(const std::function<void(MeshView, std::uint32_t)>& part,
                                      const std::string& label, const ProgressFor& progress) const {
  double all_bytes = 0.0, done_bytes = 0.0;
  for (const std::string& file : files_) all_bytes += bytes_of(file);
  const std::function<bool(double)> bar = progress(label);
  Totals totals;
  const auto count_and_give = [&](MeshView view, std::uint32_t first_id) {
    ++totals.parts;
    part(view, first_id);
  };
  for (const std::string& file : files_) {
    const double bytes = bytes_of(file);
    StreamOptions options;
    options.memory_bytes = memory_bytes_;
    options.first_id = static_cast<std::uint32_t>(totals.triangles);  // the file before keeps it in range
    if (bar) {
      options.progress = [&](double share) {
        return bar(std::min((done_bytes + share * bytes) / all_bytes, 1.0));
      };
    }
    const MeshReport report = stream_mesh(file, count_and_give, options);
    totals.triangles += report.triangles;
    totals.vertices += report.vertices;
    done_bytes += bytes;
  }
  return totals;
}

TriangleMesh StreamScene::box(const ProgressFor& progress) const {
  Bounds bounds;
  bool any = false;
  const auto grow = [&](MeshView part, std::uint32_t /*first_id*/) {
    for (const glm::uvec3& t : part.triangles) {
      const glm::vec3 corners[] = {part.positions[t.x], part.positions[t.y], part.positions[t.z]};
      if (!std::all_of(std::begin(corners), std::end(corners), is_finite)) continue;
      any = true;
      for (const glm::vec3& corner : corners) bounds.grow(corner);
    }
  };
  give(grow, "bounds", progress);
  if (!any) return {};
  return {{bounds.least, bounds.greatest}, {{0, 1, 1}}};
}

std::string StreamScene::name() const {
  return files_.size() == 1 ? files_.front()
                            : fmt::format("{} and {} more", files_.front(), files_.size() - 1);
}

StreamFrame draw_stream(const StreamScene& scene, const Camera& camera, const Run& run, int threads,
                        const ProgressFor& progress) {
  const auto begin = std::chrono::steady_clock::now();
  // No progress of its own, which would cost a copy of the frame a part.
  RasterOptions options;
  options.threads = threads;
  options.simd = run.simd.value_or(Simd::Auto);
  Rasterizer rasterizer(camera, options);
  const StreamScene::Totals totals =
      scene.give([&](MeshView part, std::uint32_t first_id) { rasterizer.draw(part, first_id); },
                 run.name + ": frame", progress);
  StreamFrame result{Frame(camera.width, camera.height), totals, 0.0};
  rasterizer.resolve(result.frame);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Camera stream_camera(const FrameOptions& options, const StreamScene& scene, const ProgressFor& progress) {
  if (options.eye && options.target) return file_camera(options, {});
  return file_camera(options, scene.box(progress));
}

}  // namespace plumb::tool
