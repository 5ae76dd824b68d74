#pragma once

#include <glm/vec3.hpp>

#include "plumb/camera.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "plumb/structure.h"

namespace plumb {

/// What a light sees, to ask which points it reaches (Williams 1978, "Casting curved shadows on curved
/// surfaces"): the frame of a camera at the light.
///
/// The answer is sampled. The map knows how far the light gets along the rays of its pixels' centres,
/// exactly, and takes a point that lies between these for its pixel: what is thinner than a pixel may be
/// missed, and shadows' edges are as coarse as the map. Structure::any() with a ray from the point to the
/// light is the exact answer; the map is the fast one, for many points. Immutable: const calls from many
/// threads are safe.
class ShadowMap {
 public:
  /// Casts the light's frame. Throws what cast() throws.
  ShadowMap(const Structure& structure, const Camera& light, const CastOptions& options = {});
  /// From a frame that was made in any way, such as by rasterize(). Throws plumb::Error when it is not of the
  /// camera's size.
  ShadowMap(const Camera& light, Frame frame);

  /// Whether the light reaches the point, as far as the map knows: the light's depth in the point's pixel is
  /// at least the point's, less `bias`. Depths are t, distances along the view axis for a camera of
  /// look_at(); `bias` is in the same unit, at least 0, and keeps surfaces from shadowing themselves between
  /// pixel centres. False for points outside the light's frame, behind it, or not finite.
  bool lit(const glm::vec3& point, float bias) const;

  /// The light's camera.
  const Camera& light() const { return light_; }
  /// What it sees.
  const Frame& frame() const { return frame_; }

 private:
  void invert();

  Camera light_;
  Frame frame_;
  // A point p from the eye is at pixel coordinates (row_x_.p, row_y_.p) / row_z_.p and at t = row_z_.p.
  glm::dvec3 row_x_{0.0}, row_y_{0.0}, row_z_{0.0};
};

}  // namespace plumb
