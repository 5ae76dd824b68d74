#pragma once

#include <span>

#include "cases/cases.h"
#include "soak/difference.h"
#include "soak/subject.h"

namespace plumb::soak {

/// A smallest case of a difference: one subject, one ray or one frame, as few triangles as still show it,
/// and numbers as simple as still show it.
struct Shrunk {
  cases::Instance instance;
  Difference difference;
};

/// Shrinks an instance whose difference was found by find_difference: leaves out rays and triangles (Zeller
/// and Hildebrandt 2002, "Simplifying and Isolating Failure-Inducing Input"), then simplifies numbers one by
/// one, as long as the same subject still differs in the same query. `subjects` are those it was found with.
Shrunk shrink(const cases::Instance& instance, const Difference& difference,
              std::span<const Subject> subjects);

}  // namespace plumb::soak
