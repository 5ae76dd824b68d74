#include "plumb/structure.h"

#include <string>
#include <utility>

#include "base/fp_mode.h"
#include "base/simd_dispatch.h"
#include "plumb/error.h"
#include "trace/structure_data.h"

// The public calls, the same for every structure: the floating-point mode kept, sizes checked, then the
// structure's table.

namespace plumb {
namespace {

using detail::with_default_fp_mode;

void check_sizes(std::size_t rays, std::size_t hits) {
  if (rays != hits) {
    throw Error("plumb: " + std::to_string(rays) + " rays but room for " + std::to_string(hits) +
                " answers; give spans of one size");
  }
}

}  // namespace

Structure::Structure(std::shared_ptr<const detail::StructureData> data) : data_(std::move(data)) {}

Hit Structure::closest(const Ray& ray) const {
  Hit hit;
  with_default_fp_mode([&] { data_->queries.closest(data_->structure.get(), &ray, &hit, 1); });
  return hit;
}

bool Structure::any(const Ray& ray) const {
  bool hit = false;
  with_default_fp_mode([&] { data_->queries.any(data_->structure.get(), &ray, &hit, 1); });
  return hit;
}

void Structure::all(const Ray& ray, std::vector<Hit>& hits) const {
  with_default_fp_mode([&] { data_->queries.all(data_->structure.get(), ray, hits); });
}

std::size_t Structure::first(const Ray& ray, std::span<Hit> hits) const {
  if (hits.empty()) return 0;
  std::size_t count = 0;
  with_default_fp_mode(
      [&] { count = data_->queries.first(data_->structure.get(), ray, hits.data(), hits.size()); });
  return count;
}

void Structure::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  check_sizes(rays.size(), hits.size());
  with_default_fp_mode(
      [&] { data_->queries.closest(data_->structure.get(), rays.data(), hits.data(), rays.size()); });
}

void Structure::any(std::span<const Ray> rays, std::span<bool> hits) const {
  check_sizes(rays.size(), hits.size());
  with_default_fp_mode(
      [&] { data_->queries.any(data_->structure.get(), rays.data(), hits.data(), rays.size()); });
}

TestCounts Structure::count_tests(std::span<const Ray> rays) const {
  TestCounts counts;
  with_default_fp_mode(
      [&] { data_->queries.count_tests(data_->structure.get(), rays.data(), rays.size(), counts); });
  return counts;
}

Structure Structure::with_simd(Simd simd) const {
  auto data = std::make_shared<detail::StructureData>(*data_);
  data->simd = detail::resolve_simd(simd);
  data->queries = data->queries_for(data->simd);
  return Structure(std::move(data));
}

Statistics Structure::statistics() const { return data_->statistics; }

}  // namespace plumb
