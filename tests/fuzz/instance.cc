#include "fuzz/instance.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace plumb::fuzz {
namespace {

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// 0 where the bytes have ended.
  std::uint8_t byte() { return next_ < bytes_.size() ? bytes_[next_++] : std::uint8_t{0}; }

  std::uint64_t word(int count) {
    std::uint64_t result = 0;
    for (int i = 0; i < count; ++i) result = result << 8 | byte();
    return result;
  }

  float coordinate() {
    const std::uint8_t kind = byte();
    float result = 0.0f;
    switch (kind % 4) {
      case 0:
        result = std::bit_cast<float>(static_cast<std::uint32_t>(word(4)));
        break;
      case 1:
        result = 0.25f * static_cast<float>(static_cast<std::int8_t>(byte()));
        break;
      case 2:
        result = earlier();
        break;
      default:
        result = std::nextafter(earlier(), kind < 128 ? -kInf : kInf);
        break;
    }
    earlier_.push_back(result);
    return result;
  }

  glm::vec3 vector() {
    const float x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }

  /// A component of a camera's directions: any double, or a few pixels' worth.
  double component() {
    const std::uint8_t kind = byte();
    if (kind % 4 == 0) return std::bit_cast<double>(word(8));
    return double{coordinate()} * (kind % 4 == 1 ? 0.125 : 1.0);
  }

  glm::dvec3 direction() {
    const double x = component(), y = component(), z = component();
    return {x, y, z};
  }

 private:
  static constexpr float kInf = std::numeric_limits<float>::infinity();

  float earlier() {
    const std::uint8_t back = byte();
    return earlier_.empty() ? 0.0f : earlier_[earlier_.size() - 1 - back % earlier_.size()];
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  std::vector<float> earlier_;
};

TriangleMesh mesh_of(Reader& reader) {
  TriangleMesh mesh;
  const std::uint32_t vertices = 1 + reader.byte() % 12u, triangles = reader.byte() % 17u;
  for (std::uint32_t i = 0; i < vertices; ++i) mesh.positions.push_back(reader.vector());
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const std::uint32_t a = reader.byte() % vertices, b = reader.byte() % vertices,
                        c = reader.byte() % vertices;
    mesh.triangles.emplace_back(a, b, c);
  }
  return mesh;
}

// From anywhere or a vertex; in any direction, or at a vertex or a point between two.
Ray ray_of(Reader& reader, const TriangleMesh& mesh) {
  const auto vertex = [&] { return mesh.positions[reader.byte() % mesh.positions.size()]; };
  const std::uint8_t kind = reader.byte();
  Ray ray;
  ray.origin = kind % 2 == 0 ? reader.vector() : vertex();
  switch (kind / 2 % 4) {
    case 0:
      ray.direction = reader.vector();
      break;
    case 1:
      ray.direction = vertex() - ray.origin;
      break;
    default: {
      const glm::vec3 a = vertex(), b = vertex();
      ray.direction = (a + 0.25f * (b - a)) - ray.origin;
      break;
    }
  }
  if (kind / 8 % 4 == 0) ray.tmin = reader.coordinate();
  if (kind / 32 % 4 == 0) ray.tmax = reader.coordinate();
  return ray;
}

Camera camera_of(Reader& reader) {
  const int width = 1 + reader.byte() % 8, height = 1 + reader.byte() % 6;
  const glm::vec3 eye = reader.vector();
  const glm::dvec3 corner = reader.direction(), du = reader.direction(), dv = reader.direction();
  return Camera(eye, corner, du, dv, width, height);
}

}  // namespace

cases::Instance instance_of(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  const std::uint8_t asked = reader.byte();
  cases::Instance instance;
  instance.mesh = mesh_of(reader);
  for (int rays = asked % 7; rays > 0; --rays) instance.rays.push_back(ray_of(reader, instance.mesh));
  if (asked >= 128) instance.camera = camera_of(reader);
  return instance;
}

}  // namespace plumb::fuzz
