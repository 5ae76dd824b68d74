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
#include "plumb/visible.h"

namespace plumb::bench {
namespace {

using Trees = std::shared_ptr<Shelf<Bvh>>;

// A tree of some width and arithmetic for an instruction set, made when first asked for.
struct TreeSource {
  Context context;
  Trees trees;
  BuildOptions options;

  bool exact() const { return options.arithmetic == Arithmetic::Exact; }
  std::string method() const {
    constexpr const char* kSuffix[] = {"-fast", "-watertight", ""};
    constexpr const char* kQuality[] = {"-fast-build", "", "-best-build"};
    return "bvh" + std::to_string(options.width) + kSuffix[static_cast<int>(options.arithmetic)] +
           kQuality[static_cast<int>(options.quality)] + (options.compact ? "-compact" : "");
  }
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

// One call for each ray.
void trace_singly(const Bvh& bvh, RaySet<Hit>& set, int threads) {
  in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) set.answers[i] = bvh.closest(set.rays[i]);
  });
}

void trace_singly(const Bvh& bvh, RaySet<bool>& set, int threads) {
  in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) set.answers[i] = bvh.any(set.rays[i]);
  });
}

// Of an exact method every bit counts, of the others what counts of a peer.
std::size_t wrong_answers(const RaySet<Hit>& set, bool exact) {
  return exact ? differences(set) : other_triangles(set);
}
std::size_t wrong_answers(const RaySet<bool>& set, bool) { return differences(set); }

template <typename Set>
Task ray_task(const TreeSource& source, Work work, Set Workload::*set, bool singly) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    Set& rays = (*workload).*set;
    if (singly) {
      trace_singly(*source.tree(*workload), rays, source.context.threads);
    } else {
      trace(*source.tree(*workload), rays, source.context.threads);
    }
    return rays.rays.size();
  };
  const auto check = [=] {
    Set& rays = (*source.context.workload()).*set;
    spoil(rays);
    run();
    return wrong_answers(rays, source.exact());
  };
  return {source.method() + (singly ? "-single" : ""), source.target(), work, source.exact(), check, run};
}

// A task that draws a frame. `draw(workload)` must leave it in workload.frame.
template <typename Draw>
Task frame_task(std::string method, std::string target, bool exact, const Context& context,
                const Draw& draw) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = context.workload();
    draw(*workload);
    return workload->frame.id.size();
  };
  const auto check = [=] {
    run();
    const std::shared_ptr<Workload> workload = context.workload();
    const Comparison result = compare(workload->frame, workload->expected_frame);
    return exact ? result.different_pixels : result.different_ids;
  };
  return {std::move(method), std::move(target), Work::Frame, exact, check, run};
}

Task cast_task(const TreeSource& source) {
  return frame_task(source.method(), source.target(), source.exact(), source.context,
                    [=](Workload& workload) {
                      CastOptions options;
                      options.threads = source.context.threads;
                      options.method = CastMethod::Rays;
                      cast(*source.tree(workload), workload.view.camera, workload.frame, options);
                    });
}

Task tile_task(const TreeSource& source) {
  return frame_task("tile", source.target(), true, source.context, [=](Workload& workload) {
    CastOptions options;
    options.threads = source.context.threads;
    options.method = CastMethod::Tiles;
    cast(*source.tree(workload), workload.view.camera, workload.frame, options);
  });
}

Task auto_task(const TreeSource& source) {
  return frame_task("auto", source.target(), true, source.context, [=](Workload& workload) {
    VisibleOptions options;
    options.threads = source.context.threads;
    visible(workload.view.mesh, *source.tree(workload), workload.view.camera, workload.frame, options);
  });
}

Task raster_task(const Context& context, Simd simd) {
  RasterOptions options;
  options.threads = context.threads;
  options.simd = simd;
  options.overwrite = true;
  return frame_task("raster", std::string(simd_name(simd)), true, context, [=](Workload& workload) {
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
  const auto bytes = [=] {
    return Bvh(source.context.workload()->view.mesh, source.options).statistics().bytes;
  };
  return {source.method(), source.target(), Work::Build, true, check, run, bytes};
}

// What a tree is asked for. The build does not depend on the instruction set or the arithmetic.
void add_ray_tasks(const TreeSource& source, bool singly, std::vector<Task>& tasks) {
  tasks.push_back(ray_task(source, Work::Camera, &Workload::camera, singly));
  tasks.push_back(ray_task(source, Work::Shadow, &Workload::shadow, singly));
  tasks.push_back(ray_task(source, Work::Occlusion, &Workload::occlusion, singly));
  tasks.push_back(ray_task(source, Work::Diffuse, &Workload::diffuse, singly));
  tasks.push_back(ray_task(source, Work::Random, &Workload::random, singly));
}

void add_tree_tasks(const TreeSource& source, bool with_build, std::vector<Task>& tasks) {
  add_ray_tasks(source, false, tasks);
  tasks.push_back(cast_task(source));
  if (with_build) tasks.push_back(build_task(source));
}

}  // namespace

std::vector<Task> our_tasks(const Context& context, const std::vector<Simd>& targets) {
  std::vector<Task> tasks;
  const auto trees = std::make_shared<Shelf<Bvh>>(context.trees);
  for (const Simd simd : targets) tasks.push_back(raster_task(context, simd));
  TreeSource source{context, trees, {}};
  source.options.threads = context.threads;
  for (const int width : {2, 4, 8}) {
    for (const Simd simd : targets) {
      if (width == 2 && simd != targets.front()) continue;
      source.options.width = width;
      source.options.simd = simd;
      add_tree_tasks(source, simd == targets.front(), tasks);
      if (width == 8) add_ray_tasks(source, true, tasks);
      if (width == 8) {
        tasks.push_back(tile_task(source));
        tasks.push_back(auto_task(source));
      }
    }
  }
  for (const Quality quality : {Quality::Fast, Quality::Best}) {
    source.options.quality = quality;
    source.options.simd = targets.front();
    add_tree_tasks(source, true, tasks);
    add_ray_tasks(source, true, tasks);
  }
  source.options.quality = Quality::Balanced;
  source.options.compact = true;
  for (const Simd simd : targets) {
    source.options.simd = simd;
    add_tree_tasks(source, simd == targets.front(), tasks);
    add_ray_tasks(source, true, tasks);
  }
  source.options.compact = false;
  for (const Arithmetic arithmetic : {Arithmetic::Watertight, Arithmetic::Fast}) {
    for (const Simd simd : targets) {
      source.options.arithmetic = arithmetic;
      source.options.simd = simd;
      add_tree_tasks(source, false, tasks);
    }
  }
  return tasks;
}

}  // namespace plumb::bench
