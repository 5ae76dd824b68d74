#pragma once

#include <gmpxx.h>

#include <optional>
#include <vector>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::witness {

struct Integer3 {
  mpz_class x, y, z;
};

/// v * 2^149.
Integer3 integers(glm::vec3 v);
Integer3 difference(const Integer3& p, const Integer3& q);
Integer3 cross(const Integer3& p, const Integer3& q);
mpz_class dot(const Integer3& p, const Integer3& q);
bool is_zero(const Integer3& p);

/// What is exactly true of a ray and a triangle, both finite.
class Facts {
 public:
  Facts(const Ray& ray, const TriangleMesh& mesh, const glm::uvec3& triangle);

  /// How many of the edge functions are exactly zero.
  int zero_edges() const;
  /// Whether the origin lies on the line of one of the edges.
  bool starts_on_edge() const;
  /// Whether it does, and the ray runs along that line.
  bool runs_along_edge() const;
  /// Whether the origin lies in the triangle's plane.
  bool starts_in_plane() const;
  /// The exact depth of the triangle's plane; nothing where its denominator is zero.
  std::optional<mpq_class> depth() const;

 private:
  Integer3 direction_;
  Integer3 corners_[3];  // minus the origin
  Integer3 normals_[3];  // of the planes through the origin and edge i, from corner i to the next
};

/// The facts of a ray and each of the mesh's finite triangles; none where the ray is not finite.
std::vector<Facts> all_facts(const Ray& ray, const TriangleMesh& mesh);

}  // namespace plumb::witness
