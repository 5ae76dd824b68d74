#include "report/hard_run.h"

#include <algorithm>
#include <mutex>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "oracle/oracle.h"
#include "support/oracle_adapter.h"

namespace plumb::tool {
namespace {

constexpr std::size_t kListed = 4;  // differences of a case

/// The exact answers about one mesh.
class Truth {
 public:
  explicit Truth(const TriangleMesh& mesh) : triangles_(witness::to_oracle(mesh)), scene_(triangles_) {}

  Hit closest(const Ray& ray) const { return witness::to_plumb(scene_.closest(witness::to_oracle(ray))); }

  std::optional<float> plane_depth(const Ray& ray, std::uint32_t id) const {
    if (id >= triangles_.size() || !oracle::can_be_seen(triangles_[id])) return std::nullopt;
    return oracle::plane_depth(witness::to_oracle(ray.origin), witness::to_oracle(ray.direction),
                               triangles_[id]);
  }

 private:
  std::vector<oracle::Triangle> triangles_;
  oracle::Scene scene_;
};

// The same rays as pixel_rays, of the oracle's own making.
std::vector<Ray> exact_pixel_rays(const cases::Instance& instance) {
  std::vector<Ray> rays;
  if (!instance.camera) return rays;
  const oracle::Camera camera = witness::to_oracle(*instance.camera);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const oracle::Ray ray = camera.ray(x, y);
      rays.push_back(
          {instance.camera->eye, ray.tmin, {ray.direction.x, ray.direction.y, ray.direction.z}, ray.tmax});
    }
  }
  return rays;
}

struct Exact {
  const std::vector<Ray>& rays;
  std::vector<Hit> hits;
};

Exact ask(const Truth& truth, const std::vector<Ray>& rays) {
  Exact exact{rays, {}};
  for (const Ray& ray : rays) exact.hits.push_back(truth.closest(ray));
  return exact;
}

void add_seen(Asked& asked, const Exact& exact) {
  asked.count += exact.hits.size();
  for (const Hit& hit : exact.hits) asked.seen += hit.id == kNone ? 0 : 1;
}

Tally compare(const std::vector<std::optional<Hit>>& answers, const Exact& exact, const Truth& truth) {
  Tally tally;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i]) continue;
    count(tally, exact.hits[i], *answers[i],
          [&](std::uint32_t id) { return truth.plane_depth(exact.rays[i], id); });
  }
  return tally;
}

std::string text_of(const Hit& hit) {
  return hit.id == kNone ? std::string("nothing") : fmt::format("triangle {} at t {:a}", hit.id, hit.t);
}

// The first answer that differs, for people.
std::string first_difference(const std::vector<std::optional<Hit>>& answers, const Exact& exact,
                             std::string_view what) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Hit& hit = exact.hits[i];
    if (answers[i] && !(*answers[i] == hit)) {
      return fmt::format("{} {} sees {} where there is {}", what, i, text_of(*answers[i]), text_of(hit));
    }
  }
  return "";
}

void merge(Asked& into, const Asked& from) {
  into.count += from.count;
  into.seen += from.seen;
  for (std::size_t i = 0; i < into.tallies.size(); ++i) into.tallies[i] += from.tallies[i];
}

CaseResult empty_result(const cases::Case& hard_case, std::size_t answerers) {
  CaseResult result{&hard_case, 0, {}, {}, {}};
  result.rays.tallies.resize(answerers);
  result.pixels.tallies.resize(answerers);
  return result;
}

void run_instance(const cases::Case& hard_case, std::uint64_t index, const std::vector<Answerer>& answerers,
                  std::uint64_t seed, CaseResult& result) {
  const cases::Instance instance = cases::make_instance(hard_case, seed, index);
  const Truth truth(instance.mesh);
  const std::vector<Ray> looks = exact_pixel_rays(instance);
  const Exact rays = ask(truth, instance.rays), pixels = ask(truth, looks);
  ++result.instances;
  add_seen(result.rays, rays);
  add_seen(result.pixels, pixels);
  for (std::size_t i = 0; i < answerers.size(); ++i) {
    const Answers answers = answerers[i].answer(instance);
    const Tally ray_tally = compare(answers.rays, rays, truth);
    const Tally pixel_tally = compare(answers.pixels, pixels, truth);
    result.rays.tallies[i] += ray_tally;
    result.pixels.tallies[i] += pixel_tally;
    if (answerers[i].is_peer() || result.differences.size() >= kListed) continue;
    for (const std::string& text :
         {first_difference(answers.rays, rays, "ray"), first_difference(answers.pixels, pixels, "pixel")}) {
      if (text.empty()) continue;
      result.differences.push_back(fmt::format("{}, seed {}, instance {}: {} {}: {}", hard_case.name, seed,
                                               index, answerers[i].method, answerers[i].simd, text));
    }
  }
}

}  // namespace

Tally HardReport::plumb_total() const {
  Tally total;
  for (const CaseResult& result : cases) {
    for (std::size_t i = 0; i < answerers.size(); ++i) {
      if (answerers[i].is_peer()) continue;
      total += result.rays.tallies[i];
      total += result.pixels.tallies[i];
    }
  }
  return total;
}

CaseResult run_case(const cases::Case& hard_case, const std::vector<Answerer>& answerers,
                    const HardOptions& options, const std::function<bool(double)>& progress) {
  const std::uint64_t count = std::max<std::uint64_t>(1, options.instances / hard_case.cost);
  tbb::enumerable_thread_specific<CaseResult> parts(
      [&] { return empty_result(hard_case, answerers.size()); });
  std::mutex mutex;
  std::uint64_t done = 0;
  const int threads = options.threads.value_or(0);
  tbb::task_arena arena(threads == 0 ? int{tbb::task_arena::automatic} : threads);
  arena.execute([&] {
    tbb::parallel_for(std::uint64_t{0}, count, [&](std::uint64_t index) {
      run_instance(hard_case, index, answerers, options.seed, parts.local());
      const std::lock_guard lock(mutex);
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(count));
    });
  });
  CaseResult result = empty_result(hard_case, answerers.size());
  for (const CaseResult& part : parts) {
    result.instances += part.instances;
    merge(result.rays, part.rays);
    merge(result.pixels, part.pixels);
    result.differences.insert(result.differences.end(), part.differences.begin(), part.differences.end());
  }
  std::sort(result.differences.begin(), result.differences.end());
  if (result.differences.size() > kListed) result.differences.resize(kListed);
  return result;
}

}  // namespace plumb::tool
