#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exact/filter_ray.h"
#include "exact/intersect.h"
#include "plumb/ray.h"
#include "plumb/statistics.h"

// What a traversal is asked for. Each query holds the limit beyond which nothing matters any more and
// takes hits one at a time, and may count what is tested; the traversals are the same for all.

namespace plumb::detail {

/// Whether a ray can see anything: valid, and some t lies between its limits.
inline bool ray_can_hit(const Ray& ray) {
  return ray_is_valid(ray) && (ray.tmin > 0.0f ? ray.tmin : 0.0f) < ray.tmax;
}

/// Counts nothing and keeps nothing.
struct NoCounts {
  void count_volumes(std::size_t) {}
  void count_triangles(std::size_t) {}
  void at_block(std::uint32_t) {}
  void keep_waiting() {}
};

/// A triangle in a lane of a block: its nine coordinates lie `stride` floats apart.
struct LaneTriangle {
  const float* corner = nullptr;
  std::size_t stride = 0;
  std::uint32_t id = kNone;

  Triangle triangle() const {
    const auto vertex = [this](std::size_t v) {
      return glm::vec3(corner[3 * v * stride], corner[(3 * v + 1) * stride], corner[(3 * v + 2) * stride]);
    };
    return {vertex(0), vertex(1), vertex(2)};
  }
};

// A query with kBoundsDepth can be offered a triangle that the line meets for certain with float bounds of
// its exact t, 0 < low <= t <= high (low is not positive where there are none), before its t is computed.
// Rounding is monotonic, so RN32(t) lies between them too. take_bounds() returns false where they do not say
// enough. kOrdered says that hits lower the limit, so that near volumes should be visited before far ones;
// kAnyHit that only whether a hit counts matters, which take_any() is told.

/// The smallest (t, id).
///
/// Triangles offered by bounds wait: only while their bounds overlap is t computed before settle(). So a ray
/// that meets surface after surface on its way to the nearest pays for one exact depth.
class ClosestQuery : public NoCounts {
 public:
  static constexpr bool kBoundsDepth = true;
  static constexpr bool kOrdered = true;
  static constexpr bool kAnyHit = false;

  explicit ClosestQuery(const Ray& ray)
      : ray_(ray), tmin_(ray.tmin > 0.0f ? ray.tmin : 0.0f), limit_(depth_limit(ray.tmax)) {}

  /// No exact t above this matters.
  float limit() const { return limit_; }
  /// Takes a line's hit; true when the traversal is done.
  bool take(float t, std::uint32_t id) {
    if (depth_counts(ray_, t) && hit_before(t, id, best_)) {
      best_ = {t, id};
      limit_ = std::min(limit_, depth_limit(t));
      if (t < low_) waiting_.id = kNone;  // farther for certain
    }
    return false;
  }
  bool take_bounds(float low, float high, const LaneTriangle& triangle) {
    if (!(low > tmin_) || !(high <= ray_.tmax)) return false;
    if (low > best_.t) return true;
    if (waiting_.id != kNone) {
      // The same one, which a tree with spatial splits offers again, has nothing to add.
      if (low > high_ || waiting_.id == triangle.id) return true;
      if (!(high < low_)) return false;
    }
    waiting_ = triangle;
    low_ = low;
    high_ = high;
    limit_ = std::min(limit_, depth_limit(high));
    return true;
  }
  static constexpr bool done() { return false; }
  /// For who is about to change the block that an offered triangle may be in.
  void keep_waiting() {
    if (waiting_.id == kNone || waiting_.corner == own_) return;
    for (std::size_t k = 0; k < 9; ++k) own_[k] = waiting_.corner[k * waiting_.stride];
    waiting_ = {own_, 1, waiting_.id};
  }
  /// Ends the traversal.
  void settle() {
    if (waiting_.id == kNone) return;
    const std::uint32_t id = waiting_.id;
    take(line_depth(ray_.origin, ray_.direction, waiting_.triangle()), id);
  }
  Hit result() const { return best_; }

 private:
  const Ray& ray_;
  Hit best_;
  float tmin_;
  float limit_;
  float low_ = 0.0f, high_ = 0.0f;  // of the one that waits
  LaneTriangle waiting_;
  float own_[9];  // coordinates of the one that waits, where they had to be kept
};

/// ClosestQuery, with what it takes to answer it.
class CountingQuery : public ClosestQuery {
 public:
  CountingQuery(const Ray& ray, TestCounts& counts) : ClosestQuery(ray), counts_(counts) {}
  void count_volumes(std::size_t n) { counts_.volumes += n; }
  void count_triangles(std::size_t n) { counts_.triangles += n; }

 private:
  TestCounts& counts_;
};

/// Whether any hit counts.
class AnyQuery : public NoCounts {
 public:
  static constexpr bool kBoundsDepth = true;
  static constexpr bool kOrdered = false;
  static constexpr bool kAnyHit = true;

  explicit AnyQuery(const Ray& ray)
      : ray_(ray), tmin_(ray.tmin > 0.0f ? ray.tmin : 0.0f), limit_(depth_limit(ray.tmax)) {}
  float limit() const { return limit_; }
  bool take(float t, std::uint32_t) { return take_any(depth_counts(ray_, t)); }
  bool take_any(bool counts) {
    hit_ = counts;
    return hit_;
  }
  bool take_bounds(float low, float high, const LaneTriangle&) {
    hit_ = low > tmin_ && high <= ray_.tmax;
    return hit_ || (low > 0.0f && (high <= tmin_ || low > ray_.tmax));
  }
  bool done() const { return hit_; }
  bool result() const { return hit_; }

 private:
  const Ray& ray_;
  float tmin_;
  float limit_;
  bool hit_ = false;
};

/// Every hit that counts, unsorted.
class AllQuery : public NoCounts {
 public:
  static constexpr bool kBoundsDepth = false;
  static constexpr bool kOrdered = false;
  static constexpr bool kAnyHit = false;

  AllQuery(const Ray& ray, std::vector<Hit>& hits) : ray_(ray), limit_(depth_limit(ray.tmax)), hits_(hits) {}
  float limit() const { return limit_; }
  bool take(float t, std::uint32_t id) {
    if (depth_counts(ray_, t)) hits_.push_back({t, id});
    return false;
  }

 private:
  const Ray& ray_;
  float limit_;
  std::vector<Hit>& hits_;
};

/// The first hits in (t, id) order, as many as there is room for.
///
/// They are kept sorted, and the last one's t is the limit once the room is full, so that neither the memory
/// nor the walk depends on how much lies behind them.
class FirstQuery : public NoCounts {
 public:
  static constexpr bool kBoundsDepth = false;
  static constexpr bool kOrdered = true;
  static constexpr bool kAnyHit = false;

  /// `room` has at least one place; all are cleared.
  FirstQuery(const Ray& ray, std::span<Hit> room) : ray_(ray), limit_(depth_limit(ray.tmax)), room_(room) {
    std::fill(room.begin(), room.end(), Hit{});
  }
  float limit() const { return limit_; }
  bool take(float t, std::uint32_t id) {
    if (!depth_counts(ray_, t) || !hit_before(t, id, room_.back())) return false;
    // From the back: what is offered late is mostly far.
    std::size_t place = count_ < room_.size() ? count_ : room_.size() - 1;
    while (place > 0 && hit_before(t, id, room_[place - 1])) --place;
    // A triangle in several cells or leaves is offered in each, with the same t, and counts once.
    if (place > 0 && room_[place - 1] == Hit{t, id}) return false;
    if (count_ < room_.size()) ++count_;
    std::move_backward(room_.begin() + static_cast<std::ptrdiff_t>(place),
                       room_.begin() + static_cast<std::ptrdiff_t>(count_ - 1),
                       room_.begin() + static_cast<std::ptrdiff_t>(count_));
    room_[place] = {t, id};
    if (count_ == room_.size()) limit_ = std::min(limit_, depth_limit(room_.back().t));
    return false;
  }
  std::size_t count() const { return count_; }

 private:
  const Ray& ray_;
  float limit_;
  std::span<Hit> room_;
  std::size_t count_ = 0;
};

inline void sort_hits(std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return hit_before(a.t, a.id, b); });
  // A structure of cells meets a triangle in each of them, with the same t: the hit's bits are the
  // triangle's.
  hits.erase(std::unique(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.id == b.id; }),
             hits.end());
}

/// The queries over one structure. `structure` is what the functions were made for. Callers hold the
/// default floating-point mode.
struct QueryTable {
  void (*closest)(const void* structure, const Ray* rays, Hit* hits, std::size_t count);
  void (*any)(const void* structure, const Ray* rays, bool* hits, std::size_t count);
  void (*all)(const void* structure, const Ray& ray, std::vector<Hit>& hits);
  /// The first hits, as FirstQuery has them; how many.
  std::size_t (*first)(const void* structure, const Ray& ray, Hit* room, std::size_t size);
  void (*count_tests)(const void* structure, const Ray* rays, std::size_t count, TestCounts& counts);
};

// The queries over spans by a structure's traversal: `Traversal::run(structure, ray, query)` offers every
// line hit that may matter to query.take() until it returns true, and tells the query what it tests. One
// offered twice counts once.

template <typename Structure, typename Traversal>
void closest_one_by_one(const void* structure, const Ray* rays, Hit* hits, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    ClosestQuery query(rays[i]);
    if (ray_can_hit(rays[i])) Traversal::run(*static_cast<const Structure*>(structure), rays[i], query);
    query.settle();
    hits[i] = query.result();
  }
}

template <typename Structure, typename Traversal>
void any_one_by_one(const void* structure, const Ray* rays, bool* hits, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    AnyQuery query(rays[i]);
    if (ray_can_hit(rays[i])) Traversal::run(*static_cast<const Structure*>(structure), rays[i], query);
    hits[i] = query.result();
  }
}

/// A table from a structure's traversal.
template <typename Structure, typename Traversal>
QueryTable make_query_table() {
  QueryTable table;
  table.closest = closest_one_by_one<Structure, Traversal>;
  table.any = any_one_by_one<Structure, Traversal>;
  table.all = [](const void* structure, const Ray& ray, std::vector<Hit>& hits) {
    hits.clear();
    AllQuery query(ray, hits);
    if (ray_can_hit(ray)) Traversal::run(*static_cast<const Structure*>(structure), ray, query);
    sort_hits(hits);
  };
  table.first = [](const void* structure, const Ray& ray, Hit* room, std::size_t size) {
    FirstQuery query(ray, {room, size});
    if (ray_can_hit(ray)) Traversal::run(*static_cast<const Structure*>(structure), ray, query);
    return query.count();
  };
  table.count_tests = [](const void* structure, const Ray* rays, std::size_t count, TestCounts& counts) {
    counts.rays += count;
    for (std::size_t i = 0; i < count; ++i) {
      CountingQuery query(rays[i], counts);
      if (ray_can_hit(rays[i])) Traversal::run(*static_cast<const Structure*>(structure), rays[i], query);
    }
  };
  return table;
}

}  // namespace plumb::detail
