#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "io/finite.h"
#include "io/mesh_builder.h"
#include "io/scratch_file.h"
#include "io/stream_job.h"
#include "io/vertex_rows.h"

// What a MeshBuilder can build other than a WholeMesh: meshes that are passed on in parts, of which only one
// is in memory.

namespace plumb::detail {

/// Gives parts and counts what a report needs of them.
class PartGiver {
 public:
  explicit PartGiver(const StreamJob& job) : sink_(job.sink), next_id_(job.limits.first_id) {}

  void give(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles);
  std::size_t unseen_triangles() const { return unseen_; }

 private:
  const PartSink& sink_;
  std::uint64_t next_id_;
  std::size_t unseen_ = 0;
};

/// A mesh whose triangles name vertices anywhere in the file. These stay on the disk: in the file itself
/// where rows of it are as good as an array, else copied into a scratch file. A part's vertices are fetched
/// together, in the order in which they are stored, so that however a file's triangles jump about, a part
/// reads through the vertices once at most. A triangle that names a vertex that is yet to come goes to a
/// second scratch file, and so do all that follow it, until the file's end.
class IndexedParts {
 public:
  explicit IndexedParts(const StreamJob& job);

  /// The file itself has the vertices from this offset on: they need no copy.
  void keep_in_place(const VertexRow& row, std::uint64_t offset);

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }
  void reserve(std::uint64_t /*vertices*/, std::uint64_t /*triangles*/) {}
  void add_vertex(const glm::vec3& position) {
    ++vertices_;
    non_finite_ += is_finite(position) ? 0 : 1;
    if (!in_place_at_) copies_.append(&position, sizeof(position));
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    ++triangles_;
    if (postponed_ || std::max({a, b, c}) >= vertices_) [[unlikely]] {
      postpone({a, b, c});
    } else {
      add_to_part({a, b, c});
    }
  }

  /// Gives what is left. All vertices that triangles name must be there.
  void finish();

  /// The report but for the faces, when all is given.
  MeshReport report() const;

 private:
  void add_to_part(const glm::uvec3& triangle) {
    part_.push_back(triangle);
    if (part_.size() == job_.sizes.part_triangles) [[unlikely]]
      give_part();
  }
  void postpone(const glm::uvec3& triangle);
  void give_part();
  void give_postponed();
  // Leave the part's vertices in `wanted_`, ascending, and make its triangles indices into that.
  void number_vertices();
  void number_by_table(std::uint32_t least, std::size_t range);
  void number_by_sorting();
  void fetch_positions();

  const StreamJob& job_;
  PartGiver giver_;
  std::uint64_t vertices_ = 0, triangles_ = 0;
  std::size_t non_finite_ = 0;

  std::vector<glm::uvec3> part_;
  std::vector<std::uint32_t> wanted_;
  std::vector<std::uint64_t> scratch_;  // of number_vertices()
  std::vector<glm::vec3> positions_;

  VertexRow row_;
  std::optional<std::uint64_t> in_place_at_;  // an offset in the file
  ScratchFile copies_;
  std::optional<ScratchFile> postponed_;
  std::unique_ptr<char[]> buffer_;
};

/// A mesh each of whose triangles has its own three vertices, which come just before it.
class SeparateParts {
 public:
  explicit SeparateParts(const StreamJob& job);

  std::uint64_t vertices() const { return first_vertex_ + positions_.size(); }
  std::uint64_t triangles() const { return triangles_; }
  void reserve(std::uint64_t /*vertices*/, std::uint64_t /*triangles*/) {}
  void add_vertex(const glm::vec3& position);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void finish();
  MeshReport report() const;

 private:
  void give_part();

  PartGiver giver_;
  std::size_t part_triangles_;
  std::uint64_t first_vertex_ = 0, triangles_ = 0;
  std::size_t non_finite_ = 0;
  std::vector<glm::uvec3> part_;
  std::vector<glm::vec3> positions_;
};

}  // namespace plumb::detail
