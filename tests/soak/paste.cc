#include "soak/paste.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <sstream>
#include <vector>

namespace plumb::soak {
namespace {

// What is written as C++: `out << Literal{value}` gives the very value.
template <typename T>
struct Literal {
  const T& value;
};
template <typename T>
Literal(const T&) -> Literal<T>;

void write_number(std::ostream& out, double value, const char* suffix) {
  if (std::isnan(value)) {
    out << "NAN";
  } else if (std::isinf(value)) {
    out << (value > 0.0 ? "INFINITY" : "-INFINITY");
  } else {
    char text[64];
    std::snprintf(text, sizeof text, "%a%s", value, suffix);
    out << text;
  }
}

std::ostream& operator<<(std::ostream& out, const Literal<float>& f) {
  write_number(out, double{f.value}, "f");
  return out;
}

std::ostream& operator<<(std::ostream& out, const Literal<double>& f) {
  write_number(out, f.value, "");
  return out;
}

template <typename T>
std::ostream& operator<<(std::ostream& out, const Literal<glm::vec<3, T, glm::defaultp>>& v) {
  return out << "{" << Literal{v.value.x} << ", " << Literal{v.value.y} << ", " << Literal{v.value.z} << "}";
}

std::ostream& operator<<(std::ostream& out, const Literal<glm::uvec3>& v) {
  return out << "{" << v.value.x << ", " << v.value.y << ", " << v.value.z << "}";
}

std::ostream& operator<<(std::ostream& out, const Literal<Ray>& r) {
  return out << "{" << Literal{r.value.origin} << ", " << Literal{r.value.tmin} << ", "
             << Literal{r.value.direction} << ", " << Literal{r.value.tmax} << "}";
}

std::ostream& operator<<(std::ostream& out, const Literal<Hit>& hit) {
  if (hit.value == Hit{}) return out << "Hit{}";
  return out << "Hit{" << Literal{hit.value.t} << ", " << hit.value.id << "}";
}

template <typename T>
std::ostream& operator<<(std::ostream& out, const Literal<std::vector<T>>& list) {
  const char* separator = "{";
  if (list.value.empty()) out << separator;
  for (const T& item : list.value) {
    out << separator << Literal{item};
    separator = ", ";
  }
  return out << "}";
}

Hit first_of(const std::vector<Hit>& hits) { return hits.empty() ? Hit{} : hits.front(); }

void write_frame_check(std::ostream& out, const Shrunk& shrunk, const Subject& subject) {
  const Camera& c = *shrunk.instance.camera;
  const auto pixel = static_cast<int>(shrunk.difference.place);
  const Hit hit = first_of(exact_hits(shrunk.instance.mesh, c.ray(pixel % c.width, pixel / c.width)));
  out << "  const Camera camera(" << Literal{c.eye} << ", " << Literal{c.corner} << ", " << Literal{c.du}
      << ", " << Literal{c.dv} << ", " << c.width << ", " << c.height << ");\n"
      << "  Frame frame(camera.width, camera.height);\n  ";
  if (subject.draw != nullptr) {
    out << subject.code << ";\n";
  } else {
    out << "cast(" << subject.code << ", camera, frame);\n";
  }
  out << "  CHECK(Hit{frame.depth[" << pixel << "], frame.id[" << pixel << "]} == " << Literal{hit} << ");\n";
}

// A call for one ray.
void write_ray_check(std::ostream& out, const Shrunk& shrunk, const std::vector<Hit>& hits) {
  out << "  const Ray ray" << Literal{shrunk.instance.rays[shrunk.difference.place]} << ";\n";
  if (shrunk.difference.query == Query::Any) {
    out << "  CHECK(structure.any(ray) == " << (hits.empty() ? "false" : "true") << ");\n";
  } else if (shrunk.difference.query == Query::Closest) {
    const Hit hit = first_of(hits);
    out << "  CHECK(structure.closest(ray) == " << Literal{hit} << ");\n";
  } else if (shrunk.difference.query == Query::First) {
    std::vector<Hit> first = hits;
    first.resize(kFirst);
    out << "  std::vector<Hit> hits(" << kFirst
        << ");\n  CHECK(structure.first(ray, hits) == " << std::min(hits.size(), kFirst)
        << ");\n  CHECK(hits == std::vector<Hit>" << Literal{first} << ");\n";
  } else {
    out << "  std::vector<Hit> hits;\n  structure.all(ray, hits);\n  CHECK(hits == std::vector<Hit>"
        << Literal{hits} << ");\n";
  }
}

// A call for a span of rays, all of which may be needed.
void write_span_check(std::ostream& out, const Shrunk& shrunk, const std::vector<Hit>& hits) {
  const bool any = shrunk.difference.query == Query::SpanAny;
  const Hit hit = first_of(hits);
  out << "  const std::vector<Ray> rays = " << Literal{shrunk.instance.rays} << ";\n  "
      << (any ? "bool" : "Hit") << " hits[" << shrunk.instance.rays.size() << "];\n  structure."
      << (any ? "any" : "closest") << "(rays, hits);\n  CHECK(hits[" << shrunk.difference.place << "] == ";
  if (any) {
    out << (hits.empty() ? "false" : "true");
  } else {
    out << Literal{hit};
  }
  out << ");\n";
}

}  // namespace

std::string test_to_paste(const Shrunk& shrunk, std::span<const Subject> subjects) {
  const Subject& subject = subjects[shrunk.difference.subject];
  const TriangleMesh& mesh = shrunk.instance.mesh;
  std::ostringstream out;
  out << "TEST_CASE(\"soak: " << subject.name << " " << shrunk.difference.text << "\") {\n"
      << "  const TriangleMesh mesh{" << Literal{mesh.positions} << ",\n                          "
      << Literal{mesh.triangles} << "};\n";
  if (shrunk.difference.query == Query::Frame) {
    write_frame_check(out, shrunk, subject);
  } else {
    const std::vector<Hit> hits = exact_hits(mesh, shrunk.instance.rays[shrunk.difference.place]);
    out << "  const auto structure = " << subject.code << ";\n";
    if (shrunk.difference.query == Query::SpanClosest || shrunk.difference.query == Query::SpanAny) {
      write_span_check(out, shrunk, hits);
    } else {
      write_ray_check(out, shrunk, hits);
    }
  }
  out << "}\n";
  return out.str();
}

}  // namespace plumb::soak
