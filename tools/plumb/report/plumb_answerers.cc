#include <memory>
#include <utility>

#include "report/answerer.h"
#include "soak/subject.h"

namespace plumb::tool {
namespace {

Answers answer(const soak::Subject& subject, const cases::Instance& instance) {
  Answers answers;
  std::unique_ptr<soak::Structure> structure;
  if (subject.build) {
    structure = subject.build(instance.mesh);
    std::vector<Hit> hits(instance.rays.size());
    structure->closest(instance.rays, hits);
    answers.rays.assign(hits.begin(), hits.end());
  }
  if (!instance.camera) return answers;
  Frame frame(instance.camera->width, instance.camera->height);
  if (structure) {
    structure->cast(*instance.camera, frame);
  } else {
    subject.draw(instance.mesh, *instance.camera, frame);
  }
  answers.pixels = to_answers(frame);
  return answers;
}

}  // namespace

std::vector<Answerer> plumb_answerers() {
  std::vector<Answerer> answerers;
  for (const soak::Subject& subject : soak::all_subjects()) {
    const std::size_t space = subject.name.find(' ');
    answerers.push_back({subject.name.substr(0, space),
                         space == std::string::npos ? "" : subject.name.substr(space + 1), "", "",
                         [subject](const cases::Instance& instance) { return answer(subject, instance); }});
  }
  return answerers;
}

std::vector<std::optional<Hit>> to_answers(const Frame& frame) {
  std::vector<std::optional<Hit>> answers;
  for (std::size_t i = 0; i < frame.id.size(); ++i) answers.emplace_back(Hit{frame.depth[i], frame.id[i]});
  return answers;
}

}  // namespace plumb::tool
