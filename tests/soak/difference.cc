#include "soak/difference.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "oracle/oracle.h"
#include "plumb/frame.h"
#include "support/oracle_adapter.h"

namespace plumb::soak {
namespace {

std::string text_of(const Hit& hit) {
  if (hit == Hit{}) return "nothing";
  char text[64];
  std::snprintf(text, sizeof text, "(%a, %u)", static_cast<double>(hit.t), static_cast<unsigned>(hit.id));
  return text;
}

std::string text_of(const std::vector<Hit>& hits) {
  std::string text;
  for (const Hit& hit : hits) text.append(text.empty() ? "" : " ").append(text_of(hit));
  return text.empty() ? "nothing" : text;
}

std::string text_of(bool hit) { return hit ? "a hit" : "no hit"; }

template <typename Answer>
std::string message(const Answer& got, const Answer& expected) {
  return "sees " + text_of(got) + " where there is " + text_of(expected);
}

Hit first_of(const std::vector<Hit>& hits) { return hits.empty() ? Hit{} : hits.front(); }

// One structure's answers to all rays.
std::optional<Difference> ask(std::size_t subject, const Structure& structure, std::span<const Ray> rays,
                              const std::vector<std::vector<Hit>>& expected) {
  std::vector<Hit> all;
  std::vector<Hit> few(kFirst, Hit{1.0f, 1});  // must be replaced
  std::vector<Hit> closest(rays.size());
  const auto any = std::make_unique<bool[]>(rays.size());
  structure.closest(rays, closest);
  structure.any(rays, std::span<bool>(any.get(), rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit first = first_of(expected[i]);
    const bool hits = !expected[i].empty();
    if (const Hit got = structure.closest(rays[i]); got != first)
      return Difference{subject, Query::Closest, i, message(got, first)};
    if (const bool got = structure.any(rays[i]); got != hits)
      return Difference{subject, Query::Any, i, message(got, hits)};
    structure.all(rays[i], all);
    if (all != expected[i]) return Difference{subject, Query::All, i, message(all, expected[i])};
    std::vector<Hit> some = expected[i];
    some.resize(kFirst);
    const std::size_t count = structure.first(rays[i], few);
    if (few != some || count != std::min(expected[i].size(), kFirst))
      return Difference{subject, Query::First, i, message(few, some)};
    if (closest[i] != first) return Difference{subject, Query::SpanClosest, i, message(closest[i], first)};
    if (any[i] != hits) return Difference{subject, Query::SpanAny, i, message(bool{any[i]}, hits)};
  }
  return std::nullopt;
}

std::optional<Difference> look(std::size_t subject, const Frame& frame, const oracle::Frame& expected) {
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const Hit got{frame.depth[i], frame.id[i]};
    const Hit right = witness::to_plumb(expected.pixels[i]);
    if (got != right) return Difference{subject, Query::Frame, i, message(got, right)};
  }
  return std::nullopt;
}

std::optional<Difference> compare_rays(const cases::Instance& instance, std::span<const Subject> subjects,
                                       const std::vector<std::unique_ptr<Structure>>& structures,
                                       const oracle::Scene& scene, Tally& tally) {
  std::vector<std::vector<Hit>> expected;
  for (const Ray& ray : instance.rays) {
    expected.push_back(witness::to_plumb(scene.all(witness::to_oracle(ray))));
    tally.hits += expected.back().empty() ? 0u : 1u;
  }
  tally.rays += instance.rays.size();
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    if (structures[s] == nullptr) continue;
    if (auto difference = ask(s, *structures[s], instance.rays, expected)) return difference;
    tally.ray_answers += 6 * instance.rays.size();
  }
  return std::nullopt;
}

std::optional<Difference> compare_frames(const cases::Instance& instance, std::span<const Subject> subjects,
                                         const std::vector<std::unique_ptr<Structure>>& structures,
                                         const oracle::Scene& scene, Tally& tally) {
  const Camera& camera = *instance.camera;
  const oracle::Frame expected = oracle::render(scene, witness::to_oracle(camera));
  tally.frames += 1;
  tally.pixels += expected.pixels.size();
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    Frame frame(camera.width, camera.height);
    if (structures[s] == nullptr) {
      subjects[s].draw(instance.mesh, camera, frame);
    } else {
      structures[s]->cast(camera, frame);
    }
    if (auto difference = look(s, frame, expected)) return difference;
    tally.pixel_answers += expected.pixels.size();
  }
  return std::nullopt;
}

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
  rays += other.rays;
  hits += other.hits;
  frames += other.frames;
  pixels += other.pixels;
  ray_answers += other.ray_answers;
  pixel_answers += other.pixel_answers;
  return *this;
}

std::optional<Difference> find_difference(const cases::Instance& instance, std::span<const Subject> subjects,
                                          Tally& tally) {
  std::vector<std::unique_ptr<Structure>> structures;
  for (const Subject& subject : subjects)
    structures.push_back(subject.build == nullptr ? nullptr : subject.build(instance.mesh));
  const oracle::Scene scene(witness::to_oracle(instance.mesh));
  if (auto difference = compare_rays(instance, subjects, structures, scene, tally)) return difference;
  if (!instance.camera.has_value()) return std::nullopt;
  return compare_frames(instance, subjects, structures, scene, tally);
}

std::vector<Hit> exact_hits(const TriangleMesh& mesh, const Ray& ray) {
  return witness::to_plumb(oracle::Scene(witness::to_oracle(mesh)).all(witness::to_oracle(ray)));
}

}  // namespace plumb::soak
