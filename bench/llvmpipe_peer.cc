#include "llvmpipe_peer.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>

#include "peers/llvmpipe_scene.h"
#include "plumb/error.h"
#include "shelf.h"

namespace plumb::bench {
namespace {

constexpr const char* kThreads = "LP_NUM_THREADS";

std::string variable_of(int threads) { return std::to_string(threads == 1 ? 0 : threads); }

}  // namespace

void set_llvmpipe_threads(int threads) { setenv(kThreads, variable_of(threads).c_str(), 1); }

std::vector<Task> llvmpipe_tasks(const Context& context) {
  const char* const set = std::getenv(kThreads);
  if (set == nullptr || variable_of(context.threads) != set || llvmpipe_version().empty()) return {};
  // One at a time: a context holds its frame, and the mesh.
  const auto scenes = std::make_shared<Shelf<peers::LlvmpipeScene>>(1);
  const auto scene_of = [=](const Workload& workload) {
    return scenes->get(context.name.title(), [&]() -> std::shared_ptr<peers::LlvmpipeScene> {
      auto scene = peers::LlvmpipeScene::open(workload.view.mesh, workload.view.camera);
      if (!scene) throw Error("plumb_bench: llvmpipe makes no frame of this size");
      return scene;
    });
  };
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = context.workload();
    scene_of(*workload)->draw();
    return workload->frame.id.size();
  };
  const auto check = [=] {
    run();
    const std::shared_ptr<Workload> workload = context.workload();
    const std::vector<std::uint32_t> ids = scene_of(*workload)->ids();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) wrong += ids[i] != workload->expected_frame.id[i] ? 1 : 0;
    return wrong;
  };
  return {{"llvmpipe", "", Work::Frame, false, check, run}};
}

std::string llvmpipe_version() {
  static const std::string name = peers::llvmpipe_name();
  return name;
}

}  // namespace plumb::bench
