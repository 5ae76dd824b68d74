#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include "plumb/ray.h"
#include "plumb/surface.h"
#include "same_bits/entries.h"
#include "support/hash.h"

// What a structure answers the rays of an entry, asked in one way or another, as a hash.

namespace plumb::same_bits {

/// By ray. Not std::vector<bool>, which threads cannot fill together.
struct Answers {
  explicit Answers(std::size_t count) : closest(count), any(count), all(count), surface(count) {}

  std::vector<Hit> closest;
  std::vector<char> any;
  std::vector<std::vector<Hit>> all;
  std::vector<Surface> surface;  ///< of the closest hit; 0 where there is none or none is asked for
};

/// How rays are asked.
struct Asking {
  std::size_t batch = 0;  ///< rays in a span, or 0: one by one, without spans
  std::vector<std::size_t> (*order)(std::size_t count) = nullptr;  ///< null: as they are
  int threads = 1;                                                 ///< that ask the same structure at once
  bool surfaces = true;                                            ///< of each closest hit, which is exact
};

inline void add(hard::Hash& hash, const Hit& hit) {
  hash.add(hit.t);
  hash.add(hit.id);
}

inline void add(hard::Hash& hash, const Answers& answers) {
  for (std::size_t i = 0; i < answers.closest.size(); ++i) {
    const Hit& closest = answers.closest[i];
    add(hash, closest);
    hash.add(static_cast<std::uint32_t>(answers.any[i]));
    hash.add(std::uint64_t{answers.all[i].size()});
    for (const Hit& hit : answers.all[i]) add(hash, hit);
    if (closest.id == kNone) continue;
    const Surface& surface = answers.surface[i];
    hash.add(surface.u);
    hash.add(surface.v);
    hash.add(surface.point);
    hash.add(surface.normal);
  }
}

/// Asks for the rays whose indices are in `which`, in that order.
template <typename Structure>
void ask(const Structure& structure, const Part& part, std::span<const std::size_t> which,
         const Asking& asking, Answers& answers) {
  const std::size_t batch = asking.batch;
  std::vector<Ray> rays;
  for (const std::size_t i : which) rays.push_back(part.rays[i]);
  std::vector<Hit> closest(rays.size());
  const auto any = std::make_unique<bool[]>(rays.size());
  if (batch == 0) {
    for (std::size_t k = 0; k < rays.size(); ++k) {
      closest[k] = structure.closest(rays[k]);
      any[k] = structure.any(rays[k]);
    }
  }
  for (std::size_t k = 0; batch != 0 && k < rays.size(); k += batch) {
    const std::size_t count = std::min(batch, rays.size() - k);
    const std::span<const Ray> some(rays.data() + k, count);
    structure.closest(some, std::span<Hit>(closest.data() + k, count));
    structure.any(some, std::span<bool>(any.get() + k, count));
  }
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::size_t i = which[k];
    answers.closest[i] = closest[k];
    answers.any[i] = any[k] ? 1 : 0;
    structure.all(rays[k], answers.all[i]);
    if (asking.surfaces && closest[k].id != kNone)
      answers.surface[i] = surface(part.mesh, rays[k], closest[k]);
  }
}

template <typename Structure>
Answers ask(const Structure& structure, const Part& part, const Asking& asking) {
  const std::size_t count = part.rays.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (asking.order != nullptr) order = asking.order(count);
  Answers answers(count);
  if (asking.threads == 1) {
    ask(structure, part, order, asking, answers);
    return answers;
  }
  std::vector<std::thread> threads;
  const auto n = static_cast<std::size_t>(asking.threads);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t begin = k * count / n, end = (k + 1) * count / n;
    threads.emplace_back([&, begin, end] {
      ask(structure, part, std::span(order).subspan(begin, end - begin), asking, answers);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return answers;
}

/// `make(part)` is a structure over the part's mesh.
template <typename Make>
std::uint64_t hash_of_rays(const Entry& entry, const Make& make, const Asking& asking = {}) {
  hard::Hash hash;
  for (const Part& part : entry.parts) add(hash, ask(make(part), part, asking));
  return hash.value();
}

/// `draw(part, camera)` is the frame of the part's mesh.
template <typename Draw>
std::uint64_t hash_of_frames(const Entry& entry, const Draw& draw) {
  hard::Hash hash;
  for (const Part& part : entry.parts) {
    for (const Camera& camera : part.cameras) {
      const auto frame = draw(part, camera);
      for (const float depth : frame.depth) hash.add(depth);
      for (const std::uint32_t id : frame.id) hash.add(id);
    }
  }
  return hash.value();
}

}  // namespace plumb::same_bits
