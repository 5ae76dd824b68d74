#include <memory>

#include "peers/llvmpipe.h"
#include "report/answerer.h"

namespace plumb::tool {

std::vector<Answerer> llvmpipe_answerers() {
  const std::shared_ptr<peers::Llvmpipe> llvmpipe = peers::Llvmpipe::open();
  if (!llvmpipe) return {};
  const auto answer = [llvmpipe](const cases::Instance& instance) {
    Answers answers;
    if (!instance.camera) return answers;
    const std::optional<Frame> frame = llvmpipe->draw(instance.mesh, *instance.camera);
    if (frame) answers.pixels = to_answers(*frame);
    return answers;
  };
  return {
      {"llvmpipe", "", llvmpipe->name(),
       "vertices projected in double, 32-bit float depth that falls with the distance; it draws what ideal "
       "pixels see, where a frame here is what rounded rays see",
       answer}};
}

}  // namespace plumb::tool
