#pragma once

#include "cases/shape.h"

namespace plumb::cases {

/// Large triangles across one axis and rays and pixels whose component along it is the same for all: the
/// exact depth is (height of the wall - height of the origin) / speed, whatever the other components.
/// Heights and speeds are any floats. In what follows "height" is the component along that axis, and the
/// others are a multiple of `scale` away from the middle.
class Walls {
 public:
  /// On an axis of its choice. All rays start at `origin_height`.
  Walls(Random& random, Instance& instance, float origin_height, float speed, float scale = 1.0f);

  /// One more triangle, at that height, which all rays and pixels meet.
  void add_wall(float height);

  /// Rays from anywhere about the middle in any direction of that speed; steeper than 45 degrees.
  void add_rays(int count);

  /// A camera of 24 x 16 pixels whose directions all have that speed.
  void add_camera();

 private:
  glm::vec3 at(float x, float y, float height) const { return turned(glm::vec3(height, x, y), axis_); }

  Random& random_;
  Instance& instance_;
  int axis_;
  float origin_height_, speed_, scale_;
};

}  // namespace plumb::cases
