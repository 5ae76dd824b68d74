#include "peers/osmesa.h"

#include <dlfcn.h>

#include "plumb/error.h"

#define GLAPI extern
#include <GL/osmesa.h>

namespace plumb::peers {

// The calls of OSMesa itself. The library stays loaded: its threads outlive a context.
struct OsmesaContext::Library {
  decltype(&OSMesaCreateContextAttribs) create;
  decltype(&OSMesaDestroyContext) destroy;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetProcAddress) address;
};

namespace {

template <typename Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace

std::unique_ptr<OsmesaContext> OsmesaContext::open() {
  void* const handle = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return nullptr;
  auto library = std::make_unique<Library>();
  if (!find(handle, "OSMesaCreateContextAttribs", library->create) ||
      !find(handle, "OSMesaDestroyContext", library->destroy) ||
      !find(handle, "OSMesaMakeCurrent", library->make_current) ||
      !find(handle, "OSMesaGetProcAddress", library->address)) {
    return nullptr;
  }
  std::unique_ptr<OsmesaContext> result(new OsmesaContext);
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  result->context_ = library->create(attributes, nullptr);
  result->library_ = std::move(library);
  if (result->context_ == nullptr) return nullptr;
  const auto load = [&]<typename Function>(Function& function, const char* name) {
    function = reinterpret_cast<Function>(result->library_->address(name));
    return function != nullptr;
  };
  GlCalls& gl = result->gl_;
#define PLUMB_LOAD(NAME) load(gl.NAME, "gl" #NAME)
  const bool complete =
      PLUMB_LOAD(AttachShader) && PLUMB_LOAD(BindBuffer) && PLUMB_LOAD(BindFramebuffer) &&
      PLUMB_LOAD(BindRenderbuffer) && PLUMB_LOAD(BindVertexArray) && PLUMB_LOAD(BufferData) &&
      PLUMB_LOAD(CheckFramebufferStatus) && PLUMB_LOAD(ClearBufferfv) && PLUMB_LOAD(ClearBufferuiv) &&
      PLUMB_LOAD(ClipControl) && PLUMB_LOAD(CompileShader) && PLUMB_LOAD(CreateProgram) &&
      PLUMB_LOAD(CreateShader) && PLUMB_LOAD(DepthFunc) && PLUMB_LOAD(DrawArrays) && PLUMB_LOAD(Enable) &&
      PLUMB_LOAD(EnableVertexAttribArray) && PLUMB_LOAD(FramebufferRenderbuffer) && PLUMB_LOAD(GenBuffers) &&
      PLUMB_LOAD(GenFramebuffers) && PLUMB_LOAD(GenRenderbuffers) && PLUMB_LOAD(GenVertexArrays) &&
      PLUMB_LOAD(GetError) && PLUMB_LOAD(GetProgramiv) && PLUMB_LOAD(GetString) && PLUMB_LOAD(LinkProgram) &&
      PLUMB_LOAD(ReadPixels) && PLUMB_LOAD(RenderbufferStorage) && PLUMB_LOAD(ShaderSource) &&
      PLUMB_LOAD(DrawElements) && PLUMB_LOAD(Finish) && PLUMB_LOAD(GetUniformLocation) &&
      PLUMB_LOAD(UniformMatrix4fv) && PLUMB_LOAD(UseProgram) && PLUMB_LOAD(VertexAttribPointer) &&
      PLUMB_LOAD(Viewport);
#undef PLUMB_LOAD
  return complete ? std::move(result) : nullptr;
}

OsmesaContext::~OsmesaContext() {
  if (context_ != nullptr) library_->destroy(static_cast<OSMesaContext>(context_));
}

void OsmesaContext::acquire() {
  if (!library_->make_current(static_cast<OSMesaContext>(context_), pixel_, GL_UNSIGNED_BYTE, 1, 1)) {
    throw Error("plumb: OSMesa refuses its context");
  }
}

void OsmesaContext::release() { library_->make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

}  // namespace plumb::peers
