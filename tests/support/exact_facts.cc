#include "support/exact_facts.h"

#include "oracle/exact.h"
#include "support/oracle_adapter.h"

namespace plumb::witness {

Integer3 integers(glm::vec3 v) { return {oracle::scaled(v.x), oracle::scaled(v.y), oracle::scaled(v.z)}; }

Integer3 difference(const Integer3& p, const Integer3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

Integer3 cross(const Integer3& p, const Integer3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

mpz_class dot(const Integer3& p, const Integer3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

bool is_zero(const Integer3& p) { return p.x == 0 && p.y == 0 && p.z == 0; }

Facts::Facts(const Ray& ray, const TriangleMesh& mesh, const glm::uvec3& triangle)
    : direction_(integers(ray.direction)) {
  const Integer3 origin = integers(ray.origin);
  for (int i = 0; i < 3; ++i) corners_[i] = difference(integers(mesh.positions[triangle[i]]), origin);
  for (int i = 0; i < 3; ++i) normals_[i] = cross(corners_[i], corners_[(i + 1) % 3]);
}

int Facts::zero_edges() const {
  int zeros = 0;
  for (const Integer3& normal : normals_) zeros += dot(direction_, normal) == 0 ? 1 : 0;
  return zeros;
}

bool Facts::starts_on_edge() const {
  return is_zero(normals_[0]) || is_zero(normals_[1]) || is_zero(normals_[2]);
}

bool Facts::runs_along_edge() const {
  for (int i = 0; i < 3; ++i) {
    const Integer3 edge = difference(corners_[(i + 1) % 3], corners_[i]);
    if (is_zero(normals_[i]) && is_zero(cross(edge, direction_))) return true;
  }
  return false;
}

bool Facts::starts_in_plane() const { return dot(corners_[0], normals_[1]) == 0; }

std::optional<mpq_class> Facts::depth() const {
  mpz_class denominator;
  for (const Integer3& normal : normals_) denominator += dot(direction_, normal);
  if (denominator == 0) return std::nullopt;
  mpq_class depth(dot(corners_[0], normals_[1]), denominator);
  depth.canonicalize();
  return depth;
}

std::vector<Facts> all_facts(const Ray& ray, const TriangleMesh& mesh) {
  std::vector<Facts> facts;
  if (!oracle::can_see(to_oracle(ray))) return facts;
  const std::vector<oracle::Triangle> triangles = to_oracle(mesh);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (oracle::can_be_seen(triangles[i])) facts.emplace_back(ray, mesh, mesh.triangles[i]);
  }
  return facts;
}

}  // namespace plumb::witness
