#include "peers/llvmpipe.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "peers/osmesa.h"
#include "plumb/error.h"

namespace plumb::peers {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec4 position;
void main() { gl_Position = position; }
)";

constexpr const char* kFragmentShader = R"(#version 450 core
layout(location = 0) out uvec2 seen;
void main() { seen = uvec2(uint(gl_PrimitiveID), floatBitsToUint(1.0 / gl_FragCoord.w)); }
)";

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

double dot(const glm::dvec3& p, const glm::dvec3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// The inverse of the matrix of columns corner, du, dv: a point p is eye + t (corner + x du + y dv), in
// pixels, with (t, t x, t y) = inverse (p - eye).
class Projection {
 public:
  explicit Projection(const Camera& camera)
      : eye_(camera.eye),
        rows_{cross(camera.du, camera.dv), cross(camera.dv, camera.corner), cross(camera.corner, camera.du)} {
    const double determinant = dot(camera.corner, rows_[0]);
    for (glm::dvec3& row : rows_) row /= determinant;
    valid_ = std::isfinite(1.0 / determinant) && determinant != 0.0;
  }

  bool valid() const { return valid_; }

  glm::dvec3 operator()(const glm::vec3& point) const {
    const glm::dvec3 p = glm::dvec3(point) - eye_;
    return {dot(rows_[0], p), dot(rows_[1], p), dot(rows_[2], p)};
  }

 private:
  glm::dvec3 eye_;
  std::array<glm::dvec3, 3> rows_;
  bool valid_ = false;
};

// Three clip-space vertices a triangle. Depth is near / t, and near a 2^24th of the farthest vertex's t:
// floats are as dense there as anywhere.
std::vector<glm::vec4> clip_space(MeshView mesh, const Camera& camera, const Projection& projection) {
  std::vector<glm::dvec3> projected;
  double farthest = 0.0;
  for (const glm::vec3& position : mesh.positions) {
    projected.push_back(projection(position));
    if (std::isfinite(projected.back().x)) farthest = std::max(farthest, projected.back().x);
  }
  const double near = 0x1p-24 * farthest;
  std::vector<glm::vec4> vertices;
  for (const glm::uvec3& triangle : mesh.triangles) {
    bool finite = true;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3& p = projected[triangle[i]];
      const glm::vec4 v(static_cast<float>(2.0 * p.y / camera.width - p.x),
                        static_cast<float>(2.0 * p.z / camera.height - p.x), static_cast<float>(near),
                        static_cast<float>(p.x));
      finite = finite && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.w);
      vertices.push_back(v);
    }
    // Behind the eye, where it is clipped; the ids of the others stay.
    if (!finite) std::fill(vertices.end() - 3, vertices.end(), glm::vec4(0, 0, 0, -1));
  }
  return vertices;
}

unsigned make_program(const GlCalls& gl) {
  const unsigned program = gl.CreateProgram();
  const std::pair<GLenum, const char*> kShaders[] = {{GL_VERTEX_SHADER, kVertexShader},
                                                     {GL_FRAGMENT_SHADER, kFragmentShader}};
  for (const auto& [kind, text] : kShaders) {
    const unsigned shader = gl.CreateShader(kind);
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    gl.AttachShader(program, shader);
  }
  gl.LinkProgram(program);
  int linked = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  return linked != 0 ? program : 0;
}

// Its context is current on this thread while it lives.
class Current {
 public:
  explicit Current(OsmesaContext& context) : context_(context) { context_.acquire(); }
  ~Current() { context_.release(); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  OsmesaContext& context_;
};

}  // namespace

struct Llvmpipe::Impl {
  std::unique_ptr<OsmesaContext> context;
  std::mutex mutex;
  std::string name;
  unsigned color = 0, depth = 0;
  int width = 0, height = 0;  // of both

  const GlCalls& gl() const { return context->gl(); }

  // What stays the same for all draws. False where the shaders do not link.
  bool prepare() {
    const Current current(*context);
    const auto text = [&](GLenum what) {
      return std::string(reinterpret_cast<const char*>(gl().GetString(what)));
    };
    const std::string version = text(GL_VERSION);
    const std::size_t mesa = version.find("Mesa ");
    name = text(GL_RENDERER) + ", " + (mesa == std::string::npos ? version : version.substr(mesa));
    const unsigned program = make_program(gl());
    if (program == 0) return false;
    gl().UseProgram(program);
    unsigned object = 0;
    gl().GenVertexArrays(1, &object);
    gl().BindVertexArray(object);
    gl().GenBuffers(1, &object);
    gl().BindBuffer(GL_ARRAY_BUFFER, object);
    gl().VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl().EnableVertexAttribArray(0);
    gl().GenFramebuffers(1, &object);
    gl().BindFramebuffer(GL_FRAMEBUFFER, object);
    gl().GenRenderbuffers(1, &color);
    gl().GenRenderbuffers(1, &depth);
    gl().Enable(GL_DEPTH_TEST);
    gl().DepthFunc(GL_GREATER);
    gl().ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    return true;
  }

  void resize(const Camera& camera) {
    if (width == camera.width && height == camera.height) return;
    width = camera.width;
    height = camera.height;
    gl().BindRenderbuffer(GL_RENDERBUFFER, color);
    gl().RenderbufferStorage(GL_RENDERBUFFER, GL_RG32UI, width, height);
    gl().FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    gl().BindRenderbuffer(GL_RENDERBUFFER, depth);
    gl().RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    gl().FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    if (gl().CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw Error("plumb: llvmpipe makes no frame of " + std::to_string(width) + " x " +
                  std::to_string(height) + " pixels");
    }
    gl().Viewport(0, 0, width, height);
  }

  void draw(const std::vector<glm::vec4>& vertices) {
    const unsigned nothing[] = {kNone, std::bit_cast<unsigned>(std::numeric_limits<float>::infinity()), 0, 0};
    const float farthest = 0.0f;
    gl().ClearBufferuiv(GL_COLOR, 0, nothing);
    gl().ClearBufferfv(GL_DEPTH, 0, &farthest);
    gl().BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec4)),
                    vertices.data(), GL_STREAM_DRAW);
    gl().DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  }

  // Row 0 is the frame's first: the projection puts it there.
  Frame read() {
    Frame frame(width, height);
    std::vector<std::array<std::uint32_t, 2>> pixels(frame.id.size());
    gl().ReadPixels(0, 0, width, height, GL_RG_INTEGER, GL_UNSIGNED_INT, pixels.data());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      frame.id[i] = pixels[i][0];
      frame.depth[i] = std::bit_cast<float>(pixels[i][1]);
    }
    if (gl().GetError() != GL_NO_ERROR) throw Error("plumb: llvmpipe failed to draw");
    return frame;
  }
};

Llvmpipe::Llvmpipe(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Llvmpipe::~Llvmpipe() = default;

std::unique_ptr<Llvmpipe> Llvmpipe::open() {
  auto impl = std::make_unique<Impl>();
  impl->context = OsmesaContext::open();
  if (!impl->context || !impl->prepare()) return nullptr;
  return std::unique_ptr<Llvmpipe>(new Llvmpipe(std::move(impl)));
}

std::string Llvmpipe::name() const { return impl_->name; }

std::optional<Frame> Llvmpipe::draw(MeshView mesh, const Camera& camera) {
  const Projection projection(camera);
  if (!projection.valid()) return std::nullopt;
  const std::vector<glm::vec4> vertices = clip_space(mesh, camera, projection);
  const std::lock_guard lock(impl_->mutex);
  const Current current(*impl_->context);
  impl_->resize(camera);
  impl_->draw(vertices);
  return impl_->read();
}

}  // namespace plumb::peers
