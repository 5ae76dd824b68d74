#include "cases/walls.h"

namespace plumb::cases {

Walls::Walls(Random& random, Instance& instance, float origin_height, float speed, float scale)
    : random_(random),
      instance_(instance),
      axis_(random.between(0, 2)),
      origin_height_(origin_height),
      speed_(speed),
      scale_(scale) {}

void Walls::add_wall(float height) {
  const auto corner = [&](float x, float y) {
    const float dx = fixed(random_), dy = fixed(random_);
    return at(scale_ * (x + dx), scale_ * (y + dy), height);
  };
  const glm::vec3 a = corner(-12, -8), b = corner(12, -8), c = corner(0, 14);
  add_turned(random_, instance_.mesh, a, b, c);
}

void Walls::add_rays(int count) {
  for (int i = 0; i < count; ++i) {
    const float x = fixed(random_), y = fixed(random_), dx = fixed(random_), dy = fixed(random_);
    instance_.rays.push_back(
        make_ray(at(scale_ * x, scale_ * y, origin_height_), at(speed_ * dx, speed_ * dy, speed_)));
  }
}

void Walls::add_camera() {
  const float x = fixed(random_), y = fixed(random_);
  const double speed = double{speed_};
  const auto step = [&](double right, double down, double forward) {
    return speed * turned(glm::dvec3(forward, right, down), axis_);
  };
  instance_.camera = grid_camera(at(scale_ * x, scale_ * y, origin_height_), step(-0.75, 0.5, 1.0),
                                 step(0.0625, 0.0, 0.0), step(0.0, -0.0625, 0.0), 24, 16);
}

}  // namespace plumb::cases
