#include <exception>
#include <optional>
#include <vector>

#include "fuzz/instance.h"
#include "fuzz/targets.h"
#include "plumb/brute_force.h"
#include "plumb/surface.h"
#include "soak/difference.h"
#include "soak/paste.h"
#include "soak/shrink.h"
#include "soak/subject.h"

namespace plumb::fuzz {
namespace {

// surface() answers to every hit.
std::string fault_of_surfaces(const cases::Instance& instance) {
  const BruteForce brute(instance.mesh);
  for (const Ray& ray : instance.rays) {
    const Hit hit = brute.closest(ray);
    if (hit.id == kNone) continue;
    const Surface s = surface(instance.mesh, ray, hit);
    if (!(s.u >= 0.0f && s.v >= 0.0f && s.u <= 1.0f && s.v <= 1.0f)) return "a weight is not within 0 and 1";
  }
  return "";
}

}  // namespace

std::string fault_of_methods(std::span<const std::uint8_t> bytes) {
  static const std::vector<soak::Subject> subjects = soak::all_subjects();
  const cases::Instance instance = instance_of(bytes);
  try {
    soak::Tally tally;
    const std::optional<soak::Difference> difference = soak::find_difference(instance, subjects, tally);
    if (!difference) return fault_of_surfaces(instance);
    return subjects[difference->subject].name + " " + difference->text + "\n" +
           soak::test_to_paste(soak::shrink(instance, *difference, subjects), subjects);
  } catch (const std::exception& error) {
    return std::string("an exception: ") + error.what();
  }
}

}  // namespace plumb::fuzz
