#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "plumb/frame.h"
#include "plumb/ray.h"
#include "scene.h"

namespace plumb::bench {

/// Rays, what they see by the reference (the binary BVH), and room for the answers of a method.
template <typename Answer>
struct RaySet {
  std::vector<Ray> rays;
  std::unique_ptr<Answer[]> expected, answers;

  std::span<Answer> expected_span() { return {expected.get(), rays.size()}; }
  std::span<Answer> answer_span() { return {answers.get(), rays.size()}; }
};

/// How many answers are not the expected ones, bit for bit (a depth is never -0 or NaN).
std::size_t differences(const RaySet<Hit>& set);
std::size_t differences(const RaySet<bool>& set);
/// How many see another triangle, whatever the depth: what can be asked of arithmetic that is not exact.
std::size_t other_triangles(const RaySet<Hit>& set);
/// Makes every answer a wrong one, so that one that a method fails to write is found.
void spoil(RaySet<Hit>& set);
void spoil(RaySet<bool>& set);

/// All that is timed at one view, with the reference's answers.
///
/// Camera rays are in blocks of 4x4 pixels, which is what packets want, and the others in the order
/// of the camera rays they start from. Shadow rays run from what the camera sees to a point light near the
/// eye, a quarter of the median depth up and to the right. Diffuse rays start there too, spread over the side
/// that the camera sees by the cosine law, from a generator seeded by the pixel: the same rays everywhere.
/// Occlusion rays are others of the same law that end after a twentieth of the median depth, for ambient
/// occlusion. Random rays start anywhere in the scene's box and go anywhere, a quarter as many as pixels.
struct Workload {
  View view;
  RaySet<Hit> camera;
  RaySet<bool> shadow;
  RaySet<bool> occlusion;
  RaySet<Hit> diffuse;
  RaySet<Hit> random;
  Frame expected_frame, frame;
};

std::unique_ptr<Workload> make_workload(View view);

/// The answers to the camera rays as a frame.
Frame frame_of_camera_rays(const Workload& workload);

}  // namespace plumb::bench
