#pragma once

#include <GL/glcorearb.h>

#include <memory>
#include <string>

// The OSMesa library, opened when first asked for, so that a program that never draws with it starts no
// slower and runs without it; and the calls of OpenGL that llvmpipe.cc makes.

namespace plumb::peers {

/// The calls, by their names without "gl".
struct GlCalls {
  PFNGLATTACHSHADERPROC AttachShader;
  PFNGLBINDBUFFERPROC BindBuffer;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus;
  PFNGLCLEARBUFFERFVPROC ClearBufferfv;
  PFNGLCLEARBUFFERUIVPROC ClearBufferuiv;
  PFNGLCLIPCONTROLPROC ClipControl;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLCREATEPROGRAMPROC CreateProgram;
  PFNGLCREATESHADERPROC CreateShader;
  PFNGLDEPTHFUNCPROC DepthFunc;
  PFNGLDRAWARRAYSPROC DrawArrays;
  PFNGLDRAWELEMENTSPROC DrawElements;
  PFNGLENABLEPROC Enable;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray;
  PFNGLFINISHPROC Finish;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer;
  PFNGLGENBUFFERSPROC GenBuffers;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays;
  PFNGLGETERRORPROC GetError;
  PFNGLGETPROGRAMIVPROC GetProgramiv;
  PFNGLGETSTRINGPROC GetString;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation;
  PFNGLLINKPROGRAMPROC LinkProgram;
  PFNGLREADPIXELSPROC ReadPixels;
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage;
  PFNGLSHADERSOURCEPROC ShaderSource;
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv;
  PFNGLUSEPROGRAMPROC UseProgram;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer;
  PFNGLVIEWPORTPROC Viewport;
};

/// A context of OpenGL 4.5, core profile, that any one thread at a time may make current.
class OsmesaContext {
 public:
  /// Null where the library, the context or one of the calls is not there.
  static std::unique_ptr<OsmesaContext> open();
  ~OsmesaContext();
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  /// Takes the context to this thread. Throws plumb::Error when it is refused.
  void acquire();
  /// Lets another thread take it.
  void release();

  const GlCalls& gl() const { return gl_; }

 private:
  OsmesaContext() = default;

  struct Library;
  std::unique_ptr<Library> library_;
  void* context_ = nullptr;
  unsigned pixel_[4] = {};  // the context's own picture, of one pixel, that nothing is drawn into
  GlCalls gl_{};
};

}  // namespace plumb::peers
