#include "peers/llvmpipe_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "peers/osmesa.h"
#include "plumb/error.h"
#include "plumb/ray.h"

namespace plumb::peers {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
uniform mat4 view;
void main() { gl_Position = view * vec4(position, 1.0); }
)";

constexpr const char* kFragmentShader = R"(#version 450 core
layout(location = 0) out uint seen;
void main() { seen = uint(gl_PrimitiveID); }
)";

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

double dot(const glm::dvec3& p, const glm::dvec3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// Rows that take a point (x, y, z, 1) to t and to its place in the frame times t, in pixels.
using Rows = std::array<std::array<double, 4>, 3>;

std::optional<Rows> rows_of(const Camera& camera) {
  const std::array<glm::dvec3, 3> minors = {cross(camera.du, camera.dv), cross(camera.dv, camera.corner),
                                            cross(camera.corner, camera.du)};
  const double determinant = dot(camera.corner, minors[0]);
  if (!std::isfinite(1.0 / determinant)) return std::nullopt;
  Rows rows;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 row = minors[i] / determinant;
    rows[i] = {row.x, row.y, row.z, -dot(row, glm::dvec3(camera.eye))};
  }
  return rows;
}

// Column by column. Depth is near / t, with `near` so small that it clips nothing that matters.
std::array<float, 16> matrix_of(const Rows& rows, const Camera& camera, double near) {
  std::array<float, 16> matrix{};
  for (std::size_t k = 0; k < 4; ++k) {
    matrix[4 * k] = static_cast<float>(2.0 * rows[1][k] / camera.width - rows[0][k]);
    matrix[4 * k + 1] = static_cast<float>(2.0 * rows[2][k] / camera.height - rows[0][k]);
    matrix[4 * k + 3] = static_cast<float>(rows[0][k]);
  }
  matrix[14] = static_cast<float>(near);
  return matrix;
}

double farthest(MeshView mesh, const Rows& rows) {
  double most = 0.0;
  for (const glm::vec3& p : mesh.positions) {
    const double t =
        rows[0][0] * double{p.x} + rows[0][1] * double{p.y} + rows[0][2] * double{p.z} + rows[0][3];
    if (std::isfinite(t)) most = std::max(most, t);
  }
  return most;
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

}  // namespace

struct LlvmpipeScene::Impl {
  std::unique_ptr<OsmesaContext> context;
  int width = 0, height = 0;
  int indices = 0;

  const GlCalls& gl() const { return context->gl(); }

  template <typename T>
  void upload(GLenum kind, std::span<const T> data) {
    unsigned buffer = 0;
    gl().GenBuffers(1, &buffer);
    gl().BindBuffer(kind, buffer);
    gl().BufferData(kind, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STATIC_DRAW);
  }

  void attach(GLenum format, GLenum place) {
    unsigned buffer = 0;
    gl().GenRenderbuffers(1, &buffer);
    gl().BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl().RenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    gl().FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  }

  // False where the shaders do not link or there is no such frame.
  bool prepare(MeshView mesh, const std::array<float, 16>& matrix) {
    const unsigned program = make_program(gl());
    if (program == 0) return false;
    gl().UseProgram(program);
    gl().UniformMatrix4fv(gl().GetUniformLocation(program, "view"), 1, GL_FALSE, matrix.data());
    unsigned object = 0;
    gl().GenVertexArrays(1, &object);
    gl().BindVertexArray(object);
    upload(GL_ARRAY_BUFFER, mesh.positions);
    gl().VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl().EnableVertexAttribArray(0);
    upload(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles);
    indices = static_cast<int>(3 * mesh.triangles.size());
    gl().GenFramebuffers(1, &object);
    gl().BindFramebuffer(GL_FRAMEBUFFER, object);
    attach(GL_R32UI, GL_COLOR_ATTACHMENT0);
    attach(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    gl().Viewport(0, 0, width, height);
    gl().Enable(GL_DEPTH_TEST);
    gl().DepthFunc(GL_GREATER);
    gl().ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    return gl().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
};

LlvmpipeScene::LlvmpipeScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LlvmpipeScene::~LlvmpipeScene() = default;

std::unique_ptr<LlvmpipeScene> LlvmpipeScene::open(MeshView mesh, const Camera& camera) {
  const std::optional<Rows> rows = rows_of(camera);
  if (!rows) return nullptr;
  auto impl = std::make_unique<Impl>();
  impl->context = OsmesaContext::open();
  if (!impl->context) return nullptr;
  impl->width = camera.width;
  impl->height = camera.height;
  impl->context->acquire();
  const double near = 0x1p-20 * farthest(mesh, *rows);
  if (!impl->prepare(mesh, matrix_of(*rows, camera, near))) return nullptr;
  return std::unique_ptr<LlvmpipeScene>(new LlvmpipeScene(std::move(impl)));
}

void LlvmpipeScene::draw() {
  impl_->context->acquire();
  const GlCalls& gl = impl_->gl();
  const unsigned nothing[] = {kNone, 0, 0, 0};
  const float farthest_depth = 0.0f;
  gl.ClearBufferuiv(GL_COLOR, 0, nothing);
  gl.ClearBufferfv(GL_DEPTH, 0, &farthest_depth);
  gl.DrawElements(GL_TRIANGLES, impl_->indices, GL_UNSIGNED_INT, nullptr);
  gl.Finish();
}

std::vector<std::uint32_t> LlvmpipeScene::ids() {
  impl_->context->acquire();
  std::vector<std::uint32_t> ids(static_cast<std::size_t>(impl_->width) *
                                 static_cast<std::size_t>(impl_->height));
  impl_->gl().ReadPixels(0, 0, impl_->width, impl_->height, GL_RED_INTEGER, GL_UNSIGNED_INT, ids.data());
  if (impl_->gl().GetError() != GL_NO_ERROR) throw Error("plumb: llvmpipe failed to draw");
  return ids;
}

std::string llvmpipe_name() {
  const std::unique_ptr<OsmesaContext> context = OsmesaContext::open();
  if (!context) return "";
  context->acquire();
  return reinterpret_cast<const char*>(context->gl().GetString(GL_RENDERER));
}

}  // namespace plumb::peers
