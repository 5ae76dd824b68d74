#include "ours.h"

#include <memory>
#include <span>
#include <string>
#include <utility>

#include "chunks.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "plumb/raster.h"

namespace plumb::bench {
namespace {

using Trees = std::shared_ptr<Shelf<Bvh>>;

// A tree of some width for an instruction set, made when first asked for.
struct TreeSource {
  Context context;
  Trees trees;
  BuildOptions options;

  std::string method() const { return "bvh" + std::to_string(options.width); }
  // The binary tree is plain scalar code.
  std::string target() const { return options.width == 2 ? "" : std::string(simd_name(options.simd)); }
  std::shared_ptr<Bvh> tree(const Workload& workload) const {
    return trees->get(context.name.title() + "/" + method() + "/" + target(),
                      [&] { return std::make_shared<Bvh>(workload.view.mesh, options); });
  }
};

void trace(const Bvh& bvh, RaySet<Hit>& set, int threads) {
  in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    bvh.closest(std::span<const Ray>(set.rays).subspan(first, count),
                set.answer_span().subspan(first, count));
  });
}

void trace(const Bvh& bvh, RaySet<bool>& set, int threads) {
  in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    bvh.any(std::span<const Ray>(set.rays).subspan(first, count), set.answer_span().subspan(first, count));
  });
}

template <typename Set>
Task ray_task(const TreeSource& source, Work work, Set Workload::*set) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    Set& rays = (*workload).*set;
    trace(*source.tree(*workload), rays, source.context.threads);
    return rays.rays.size();
  };
  const auto check = [=] {
    Set& rays = (*source.context.workload()).*set;
    spoil(rays);
    run();
    return differences(rays);
  };
  return {source.method(), source.target(), work, true, check, run};
}

// A task that draws a frame. `draw(workload)` must leave it in workload.frame.
template <typename Draw>
Task frame_task(std::string method, std::string target, const Context& context, const Draw& draw) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = context.workload();
    draw(*workload);
    return workload->frame.id.size();
  };
  const auto check = [=] {
    run();
    const std::shared_ptr<Workload> workload = context.workload();
    return compare(workload->frame, workload->expected_frame).different_pixels;
  };
  return {std::move(method), std::move(target), Work::Frame, true, check, run};
}

Task cast_task(const TreeSource& source) {
  return frame_task(source.method(), source.target(), source.context, [=](Workload& workload) {
    CastOptions options;
    options.threads = source.context.threads;
    cast(*source.tree(workload), workload.view.camera, workload.frame, options);
  });
}

Task raster_task(const Context& context, Simd simd) {
  RasterOptions options;
  options.threads = context.threads;
  options.simd = simd;
  return frame_task("raster", std::string(simd_name(simd)), context, [=](Workload& workload) {
    workload.frame.clear();
    rasterize(workload.view.mesh, workload.view.camera, workload.frame, options);
  });
}

// A build's tree is checked by what the camera sees in it.
Task build_task(const TreeSource& source) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    const Bvh bvh(workload->view.mesh, source.options);
    return bvh.statistics().triangles;
  };
  const auto check = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    spoil(workload->camera);
    trace(Bvh(workload->view.mesh, source.options), workload->camera, source.context.threads);
    return differences(workload->camera);
  };
  return {source.method(), source.target(), Work::Build, true, check, run};
}

}  // namespace

std::vector<Task> our_tasks(const Context& context, const std::vector<Simd>& targets) {
  std::vector<Task> tasks;
  const auto trees = std::make_shared<Shelf<Bvh>>(context.trees);
  for (const Simd simd : targets) tasks.push_back(raster_task(context, simd));
  for (const int width : {2, 4, 8}) {
    for (const Simd simd : targets) {
      if (width == 2 && simd != targets.front()) continue;
      TreeSource source{context, trees, {}};
      source.options.width = width;
      source.options.threads = context.threads;
      source.options.simd = simd;
      tasks.push_back(ray_task(source, Work::Camera, &Workload::camera));
      tasks.push_back(ray_task(source, Work::Shadow, &Workload::shadow));
      tasks.push_back(ray_task(source, Work::Diffuse, &Workload::diffuse));
      tasks.push_back(cast_task(source));
      // The build does not depend on the instruction set.
      if (simd == targets.front()) tasks.push_back(build_task(source));
    }
  }
  return tasks;
}

}  // namespace plumb::bench
