#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/cases.h"
#include "plumb/frame.h"
#include "plumb/ray.h"

// Who answers: plumb's methods and the peers of this build.

namespace plumb::tool {

/// What is said of an instance. Where one cannot be asked there is no answer.
struct Answers {
  std::vector<std::optional<Hit>> rays;    ///< of each ray; empty from one that only makes frames
  std::vector<std::optional<Hit>> pixels;  ///< of each pixel of the frame, row by row; empty without one
};

struct Answerer {
  std::string method;   ///< "bvh8", "embree-fast"
  std::string simd;     ///< the instruction set, where one is chosen
  std::string version;  ///< of a peer: "Embree 3.13.5"; plumb's own methods have none
  std::string remark;   ///< of a peer: how it is asked, a few words without a full stop
  std::function<Answers(const cases::Instance&)> answer;  ///< may be called from many threads

  bool is_peer() const { return !version.empty(); }
};

/// Every method of plumb on every instruction set of this machine.
std::vector<Answerer> plumb_answerers();

/// Embree's single-ray call on scenes in fast and in robust mode; empty in a build without it.
std::vector<Answerer> embree_answerers();

/// Mesa's llvmpipe; empty in a build or on a machine without it.
std::vector<Answerer> llvmpipe_answerers();

/// A frame's pixels as answers.
std::vector<std::optional<Hit>> to_answers(const Frame& frame);

}  // namespace plumb::tool
