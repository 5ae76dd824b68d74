#include "report/speed_run.h"

#include <algorithm>
#include <memory>

#include "bench/embree_peer.h"
#include "bench/ours.h"
#include "bench/rays.h"
#include "bench/scene.h"
#include "bench/shelf.h"
#include "picture.h"
#include "report/tally.h"

namespace plumb::tool {
namespace {

using bench::Task;
using bench::Work;
using bench::Workload;

constexpr std::size_t kTrees = 64;

std::vector<Task> tasks_of(const bench::ViewName& name, const SpeedOptions& options,
                           const std::shared_ptr<Workload>& workload) {
  const bench::Context context{name, options.threads, kTrees, "", [workload] { return workload; }};
  std::vector<Task> tasks = bench::our_tasks(context, options.targets);
  for (Task& task : bench::embree_tasks(context)) tasks.push_back(std::move(task));
  // Builds have no errors, and what is left out of the rays and rows would show the same ones.
  const auto is_left_out = [](const Task& task) {
    const auto names = [&](const char* part) { return task.method.find(part) != std::string::npos; };
    return task.work == Work::Build || task.work == Work::Occlusion || task.work == Work::Random ||
           names("-single") || names("-build") || names("-low") || names("-high") || names("embree-fast-4");
  };
  std::erase_if(tasks, is_left_out);
  return tasks;
}

SpeedRow& row_of(std::vector<SpeedRow>& rows, const Task& task) {
  for (SpeedRow& row : rows) {
    if (row.row.method == task.method && row.row.target == task.target) return row;
  }
  rows.push_back({});
  rows.back().row.method = task.method;
  rows.back().row.target = task.target;
  rows.back().row.exact = task.exact;
  return rows.back();
}

std::vector<Hit> hits_of(const Frame& frame) {
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < frame.id.size(); ++i) hits.push_back({frame.depth[i], frame.id[i]});
  return hits;
}

// What a task's answers are like, just after it was checked.
void note_errors(const Task& task, Workload& workload, SpeedScene& scene) {
  SpeedRow& row = row_of(scene.rows, task);
  if (task.work == Work::Camera) {
    row.camera = errors_of(workload.camera.expected_span(), workload.camera.answer_span());
  } else if (task.work == Work::Diffuse) {
    row.diffuse = errors_of(workload.diffuse.expected_span(), workload.diffuse.answer_span());
  } else if (task.work == Work::Frame) {
    row.frame = errors_of(hits_of(workload.expected_frame), hits_of(workload.frame));
  }
  // Of a peer's calls of several widths the first.
  const bool is_wide = task.method.ends_with("-8") || task.method.ends_with("-16");
  if (task.work != Work::Camera || task.exact || is_wide) return;
  const Frame seen = bench::frame_of_camera_rays(workload);
  const Comparison comparison = compare(seen, workload.expected_frame);
  scene.pictures.push_back({task.target.empty() ? task.method : task.method + " " + task.target,
                            comparison.different_pixels, difference_picture(workload.expected_frame, seen)});
}

}  // namespace

Errors errors_of(std::span<const Hit> exact, std::span<const Hit> answers) {
  Errors errors;
  errors.asked = exact.size();
  std::vector<std::uint32_t> ulps;
  double sum = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].id != answers[i].id) {
      ++errors.wrong_ids;
      errors.lost += answers[i].id == kNone ? 1 : 0;
      errors.extra += exact[i].id == kNone ? 1 : 0;
    } else if (exact[i].id != kNone) {
      const std::uint32_t off = ulps_between(exact[i].t, answers[i].t);
      ulps.push_back(off);
      sum += off;
      errors.other_depths += off == 0 ? 0 : 1;
      errors.worst_ulps = std::max(errors.worst_ulps, off);
    }
  }
  errors.seen_right = ulps.size();
  if (ulps.empty()) return errors;
  errors.mean_ulps = sum / static_cast<double>(ulps.size());
  const auto place = ulps.begin() + static_cast<std::ptrdiff_t>((ulps.size() - 1) * 999 / 1000);
  std::nth_element(ulps.begin(), place, ulps.end());
  errors.ulps_999 = *place;
  return errors;
}

bool SpeedReport::agrees() const {
  for (const SpeedScene& scene : scenes) {
    for (const SpeedRow& row : scene.rows) {
      if (!row.row.exact) continue;
      for (const Errors* errors : {&row.camera, &row.diffuse, &row.frame}) {
        if (errors->wrong_ids + errors->other_depths != 0) return false;
      }
    }
  }
  return true;
}

SpeedScene measure_scene(const std::string& scene, const SpeedOptions& options,
                         const std::function<bool(double)>& progress) {
  const bench::ViewName name{scene, "", ""};
  const std::shared_ptr<Workload> workload =
      bench::make_workload(bench::load_view(name, options.width, options.height));
  SpeedScene result{name.title(), workload->view.mesh.triangles.size(),    workload->diffuse.rays.size(),
                    {},           depth_picture(workload->expected_frame), {}};
  const std::vector<Task> tasks = tasks_of(name, options, workload);
  std::size_t checked = 0;
  const std::vector<bench::Row> speeds = bench::measure(
      tasks, options.rounds, options.threads, bench::Baseline::SingleRays, [&](const Task& task) {
        note_errors(task, *workload, result);
        if (progress) progress(0.5 * static_cast<double>(++checked) / static_cast<double>(tasks.size()));
      });
  for (const bench::Row& speed : speeds) {
    for (SpeedRow& row : result.rows) {
      if (row.row.method == speed.method && row.row.target == speed.target) row.row = speed;
    }
  }
  if (progress) progress(1.0);
  return result;
}

}  // namespace plumb::tool
