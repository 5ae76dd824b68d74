#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "help.h"
#include "output_file.h"
#include "plumb/error.h"
#include "plumb/version.h"
#include "progress_bar.h"
#include "scene.h"
#include "soak/difference.h"
#include "soak/paste.h"
#include "soak/shrink.h"
#include "soak/source.h"
#include "soak/subject.h"
#include "text.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

using Clock = std::chrono::steady_clock;

struct SoakOptions {
  double seconds = 60.0;
  std::uint64_t seed = 1;
  int threads = 0;
  bool json = false;
};

/// What was compared of one kind of instances.
struct KindTally {
  std::uint64_t instances = 0;
  soak::Tally tally;
};

struct Found {
  soak::Drawn drawn;
  soak::Difference difference;
};

volatile std::sig_atomic_t interrupted = 0;

/// While one lives, an interrupt or a request to end stops the search instead of the process.
class CatchInterrupts {
 public:
  CatchInterrupts() {
    const auto note = [](int) { interrupted = 1; };
    old_interrupt_ = std::signal(SIGINT, note);
    old_terminate_ = std::signal(SIGTERM, note);
  }
  ~CatchInterrupts() {
    std::signal(SIGINT, old_interrupt_);
    std::signal(SIGTERM, old_terminate_);
  }
  CatchInterrupts(const CatchInterrupts&) = delete;
  CatchInterrupts& operator=(const CatchInterrupts&) = delete;

 private:
  void (*old_interrupt_)(int);
  void (*old_terminate_)(int);
};

/// Draws and compares on several threads until the time is over or an answer differs.
class Soak {
 public:
  Soak(const SoakOptions& options, std::vector<soak::Subject> subjects)
      : options_(options),
        subjects_(std::move(subjects)),
        start_(Clock::now()),
        progress_(progress_bar("soak")) {}

  void run() {
    const int wanted =
        options_.threads > 0 ? options_.threads : static_cast<int>(std::thread::hardware_concurrency());
    const CatchInterrupts catch_interrupts;
    {
      std::vector<std::jthread> workers;
      for (int i = 0; i < std::max(1, wanted); ++i) workers.emplace_back([this] { work(); });
    }
    if (failure_) std::rethrow_exception(failure_);
  }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  const soak::Tally& tally() const { return tally_; }
  std::uint64_t instances() const { return instances_; }
  const std::map<std::string, KindTally>& kinds() const { return kinds_; }
  const std::optional<Found>& found() const { return found_; }
  const std::vector<soak::Subject>& subjects() const { return subjects_; }

 private:
  void work() {
    try {
      while (!stop_ && interrupted == 0 && seconds() < options_.seconds) step();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
  }

  void step() {
    soak::Drawn drawn = soak::draw_instance(options_.seed, next_++);
    soak::Tally tally;
    std::optional<soak::Difference> difference = soak::find_difference(drawn.instance, subjects_, tally);
    const std::lock_guard lock(mutex_);
    tally_ += tally;
    ++instances_;
    KindTally& kind = kinds_[drawn.kind];
    kind.tally += tally;
    ++kind.instances;
    if (difference.has_value() && !found_.has_value()) {
      found_ = Found{std::move(drawn), std::move(*difference)};
      stop_ = true;
    }
    if (progress_ && !progress_(std::min(1.0, seconds() / options_.seconds))) stop_ = true;
  }

  const SoakOptions& options_;
  std::vector<soak::Subject> subjects_;
  Clock::time_point start_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // of all below
  std::function<bool(double)> progress_;
  soak::Tally tally_;
  std::uint64_t instances_ = 0;
  std::map<std::string, KindTally> kinds_;
  std::optional<Found> found_;
  std::exception_ptr failure_;
};

nlohmann::json to_json(const soak::Tally& tally) {
  return {{"rays", tally.rays},     {"hits", tally.hits},     {"ray_answers", tally.ray_answers},
          {"frames", tally.frames}, {"pixels", tally.pixels}, {"pixel_answers", tally.pixel_answers}};
}

nlohmann::json summary(const SoakOptions& options, const Soak& soak) {
  nlohmann::json subjects = nlohmann::json::array();
  for (const soak::Subject& subject : soak.subjects()) subjects.push_back(subject.name);
  nlohmann::json kinds = nlohmann::json::object();
  for (const auto& [name, kind] : soak.kinds()) {
    kinds[name] = to_json(kind.tally);
    kinds[name]["instances"] = kind.instances;
  }
  nlohmann::json json = {{"plumb", PLUMB_VERSION},
                         {"seed", options.seed},
                         {"seconds", soak.seconds()},
                         {"subjects", subjects},
                         {"instances", soak.instances()},
                         {"kinds", kinds},
                         {"agree", !soak.found().has_value()},
                         {"difference", nullptr}};
  json.update(to_json(soak.tally()));
  return json;
}

ExitStatus run_soak(const SoakOptions& options) {
  if (!(options.seconds > 0.0)) {
    throw Error(fmt::format("plumb: --seconds {}: give a time above 0", options.seconds));
  }
  check_threads(options.threads);
  Soak soak(options, soak::all_subjects());
  fmt::print(stderr, "seed {}, {} s, {} methods and targets against the oracle\n", options.seed,
             options.seconds, soak.subjects().size());
  soak.run();
  nlohmann::json json = summary(options, soak);
  const soak::Tally& tally = soak.tally();
  fmt::print(
      stderr,
      "{} instances in {:.1f} s: {} rays ({} of them hit), {} answers about them; {} frames of {} pixels, {} "
      "answers\n",
      soak.instances(), soak.seconds(), tally.rays, tally.hits, tally.ray_answers, tally.frames, tally.pixels,
      tally.pixel_answers);
  if (soak.found().has_value()) {
    const Found& found = *soak.found();
    fmt::print(stderr, "{}: {} {}\nshrinking ...\n", found.drawn.name,
               soak.subjects()[found.difference.subject].name, found.difference.text);
    const soak::Shrunk shrunk = soak::shrink(found.drawn.instance, found.difference, soak.subjects());
    const std::string test = soak::test_to_paste(shrunk, soak.subjects());
    json["difference"] = {{"instance", found.drawn.name},
                          {"subject", soak.subjects()[found.difference.subject].name},
                          {"text", found.difference.text},
                          {"test", test}};
    if (!options.json) print_line(test);
  } else {
    fmt::print(stderr, "no answer differs from the oracle's\n");
  }
  if (options.json) print_line(json.dump(2));
  return soak.found().has_value() ? kDiffer : kAgree;
}

}  // namespace

void add_soak_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("soak", "Search hard scenes, rays and cameras for a wrong answer");
  const auto options = std::make_shared<SoakOptions>();
  command->add_option("--seconds", options->seconds, "how long to search")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of what is drawn; another seed draws other instances")
      ->type_name("S")
      ->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print what was compared as JSON on standard output");
  command->footer(soak_help());
  command->callback([options, &status] { status = run_soak(*options); });
}

}  // namespace plumb::tool
