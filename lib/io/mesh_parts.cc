#include "io/mesh_parts.h"

#include <algorithm>
#include <span>

namespace plumb::detail {
namespace {

static_assert(kPartTriangleBytes ==
              sizeof(glm::uvec3) + 3 * (sizeof(glm::vec3) + sizeof(std::uint32_t) + sizeof(std::uint64_t)));

template <typename Visit>
void for_each_corner(std::vector<glm::uvec3>& triangles, const Visit& visit) {
  for (glm::uvec3& t : triangles) {
    visit(t.x);
    visit(t.y);
    visit(t.z);
  }
}

}  // namespace

void PartGiver::give(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
  if (triangles.empty()) return;
  if (!std::all_of(positions.begin(), positions.end(), is_finite)) {
    unseen_ +=
        static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), [&](const glm::uvec3& t) {
          return !(is_finite(positions[t.x]) && is_finite(positions[t.y]) && is_finite(positions[t.z]));
        }));
  }
  sink_(MeshView(positions, triangles), static_cast<std::uint32_t>(next_id_));
  next_id_ += triangles.size();
}

IndexedParts::IndexedParts(const StreamJob& job)
    : job_(job),
      giver_(job),
      copies_(job.sizes.buffer_bytes),
      buffer_(std::make_unique_for_overwrite<char[]>(job.sizes.buffer_bytes)) {
  part_.reserve(job.sizes.part_triangles);
  wanted_.reserve(3 * job.sizes.part_triangles);
  positions_.reserve(3 * job.sizes.part_triangles);
  scratch_.reserve(3 * job.sizes.part_triangles);
}

void IndexedParts::keep_in_place(const VertexRow& row, std::uint64_t offset) {
  row_ = row;
  in_place_at_ = offset;
}

void IndexedParts::postpone(const glm::uvec3& triangle) {
  if (!postponed_) {
    give_part();
    postponed_.emplace(job_.sizes.buffer_bytes);
    job_.progress.postpone();
  }
  postponed_->append(&triangle, sizeof(triangle));
}

void IndexedParts::give_part() {
  if (part_.empty()) return;
  number_vertices();
  fetch_positions();
  giver_.give(positions_, part_);
  part_.clear();
}

// Most files name neighbours together: then the part's vertices are among few, and a table of these is filled
// and read in three walks. Otherwise the corners are sorted.
void IndexedParts::number_vertices() {
  std::uint32_t least = part_.front().x, greatest = least;
  for_each_corner(part_, [&](std::uint32_t v) {
    least = std::min(least, v);
    greatest = std::max(greatest, v);
  });
  const std::size_t range = std::size_t{greatest - least} + 1;
  wanted_.clear();
  scratch_.clear();
  if (range <= 3 * job_.sizes.part_triangles) {
    number_by_table(least, range);
  } else {
    number_by_sorting();
  }
}

void IndexedParts::number_by_table(std::uint32_t least, std::size_t range) {
  scratch_.assign(range, 0);
  for_each_corner(part_, [&](std::uint32_t v) { scratch_[v - least] = 1; });
  for (std::size_t i = 0; i < range; ++i) {
    if (scratch_[i] == 0) continue;
    scratch_[i] = wanted_.size();
    wanted_.push_back(least + static_cast<std::uint32_t>(i));
  }
  for_each_corner(part_, [&](std::uint32_t& v) { v = static_cast<std::uint32_t>(scratch_[v - least]); });
}

// Sorts the corners by vertex, each with its place in the lower half.
void IndexedParts::number_by_sorting() {
  for (std::size_t t = 0; t < part_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      scratch_.push_back(std::uint64_t{part_[t][k]} << 32 | (3 * t + static_cast<std::size_t>(k)));
    }
  }
  std::sort(scratch_.begin(), scratch_.end());
  for (const std::uint64_t corner : scratch_) {
    const auto vertex = static_cast<std::uint32_t>(corner >> 32);
    if (wanted_.empty() || wanted_.back() != vertex) wanted_.push_back(vertex);
    const auto place = static_cast<std::uint32_t>(corner);
    part_[place / 3][static_cast<int>(place % 3)] = static_cast<std::uint32_t>(wanted_.size() - 1);
  }
}

void IndexedParts::fetch_positions() {
  positions_.resize(wanted_.size());
  const auto read = [&](std::uint64_t offset, char* to, std::size_t bytes) {
    if (in_place_at_) {
      job_.window.file.read(*in_place_at_ + offset, to, bytes);
    } else {
      copies_.read(offset, to, bytes);
    }
  };
  gather_vertices(read, row_, wanted_, std::span(buffer_.get(), job_.sizes.buffer_bytes), positions_.data());
}

void IndexedParts::give_postponed() {
  const std::size_t block = job_.sizes.buffer_bytes / sizeof(glm::uvec3);
  std::vector<glm::uvec3> triangles(block);
  const std::uint64_t count = postponed_->size() / sizeof(glm::uvec3);
  for (std::uint64_t first = 0; first < count; first += block) {
    triangles.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block, count - first)));
    postponed_->read(first * sizeof(glm::uvec3), reinterpret_cast<char*>(triangles.data()),
                     triangles.size() * sizeof(glm::uvec3));
    for (const glm::uvec3& triangle : triangles) add_to_part(triangle);
    job_.progress.given(static_cast<double>(first + triangles.size()) / static_cast<double>(count));
  }
}

void IndexedParts::finish() {
  if (postponed_) give_postponed();
  give_part();
}

MeshReport IndexedParts::report() const {
  MeshReport report;
  report.vertices = vertices_;
  report.triangles = triangles_;
  report.non_finite_vertices = non_finite_;
  report.unseen_triangles = giver_.unseen_triangles();
  return report;
}

SeparateParts::SeparateParts(const StreamJob& job) : giver_(job), part_triangles_(job.sizes.part_triangles) {
  part_.reserve(part_triangles_);
  positions_.reserve(3 * part_triangles_);
}

void SeparateParts::add_vertex(const glm::vec3& position) {
  positions_.push_back(position);
  non_finite_ += is_finite(position) ? 0 : 1;
}

void SeparateParts::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto first = static_cast<std::uint32_t>(first_vertex_);
  part_.emplace_back(a - first, b - first, c - first);
  ++triangles_;
  if (part_.size() == part_triangles_) give_part();
}

void SeparateParts::give_part() {
  giver_.give(positions_, part_);
  first_vertex_ += positions_.size();
  positions_.clear();
  part_.clear();
}

void SeparateParts::finish() { give_part(); }

MeshReport SeparateParts::report() const {
  MeshReport report;
  report.vertices = vertices();
  report.triangles = triangles_;
  report.non_finite_vertices = non_finite_;
  report.unseen_triangles = giver_.unseen_triangles();
  return report;
}

}  // namespace plumb::detail
