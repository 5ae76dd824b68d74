#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "report/hard_document.h"

namespace plumb::tool {
namespace {

// 1234567 as "1,234,567".
std::string grouped(std::uint64_t number) {
  return number < 1000 ? std::to_string(number)
                       : fmt::format("{},{:03}", grouped(number / 1000), number % 1000);
}

// Two digits, so that a rare error still shows: "12 %", "0.034 %", "0".
std::string percentage(std::uint64_t part, std::uint64_t whole) {
  if (part == 0) return "0";
  if (part == whole) return "100 %";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return percent < 99.5 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.4g} %", percent);
}

std::string ulps(const Tally& tally) {
  if (tally.worst_ulps < 100'000) return grouped(tally.worst_ulps);
  return tally.worst_ulps == 0xffffffffu ? "NaN" : fmt::format("{:.1f} million", 1e-6 * tally.worst_ulps);
}

// Shares of what a peer was asked: lost, extra or on another surface, and after a + other triangles at the
// same depth.
std::string shares(const Tally& tally) {
  if (tally.asked == 0) return "";
  const std::string wrong = percentage(tally.wrong_ids - tally.same_depth, tally.asked);
  return tally.same_depth == 0 ? wrong : wrong + " + " + percentage(tally.same_depth, tally.asked);
}

// Rays and pixels together.
Tally both(const CaseResult& result, std::size_t answerer) {
  Tally tally = result.rays.tallies[answerer];
  tally += result.pixels.tallies[answerer];
  return tally;
}

std::uint64_t plumb_differences(const CaseResult& result, const std::vector<Answerer>& answerers) {
  std::uint64_t differences = 0;
  for (std::size_t i = 0; i < answerers.size(); ++i) {
    if (!answerers[i].is_peer()) differences += both(result, i).different;
  }
  return differences;
}

// The names of plumb's methods, each once, and of the instruction sets.
std::pair<std::string, std::string> plumb_names(const std::vector<Answerer>& answerers) {
  std::string methods, targets;
  const auto add = [](std::string& list, const std::string& name) {
    if (name.empty() || (", " + list + ",").find(", " + name + ",") != std::string::npos) return;
    list.append(list.empty() ? "" : ", ").append(name);
  };
  for (const Answerer& answerer : answerers) {
    if (answerer.is_peer()) continue;
    add(methods, answerer.method);
    add(targets, answerer.simd);
  }
  return {methods, targets};
}

class Document {
 public:
  explicit Document(const HardReport& report) : report_(report) {}

  std::string text() {
    introduction();
    overview();
    std::string_view group;
    for (const CaseResult& result : report_.cases) {
      if (result.hard_case->group != group) {
        group = result.hard_case->group;
        line("\n## {}", group);
      }
      details(result);
    }
    return std::move(text_);
  }

 private:
  template <typename... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  void introduction() {
    const auto [methods, targets] = plumb_names(report_.answerers);
    line("# Hard cases\n");
    const HardOptions& options = report_.options;
    line(
        "Made by `plumb report --hard --seed {} --instances {}{}`, not by hand. Each case is one way in "
        "which",
        options.seed, options.instances, options.cases.empty() ? "" : " --cases " + options.cases);
    line("a ray or a frame is hard to answer exactly, as many small scenes drawn from a seed");
    line("([tests/cases](../tests/cases)). Every answer is compared with that of rational arithmetic");
    line("([tests/oracle](../tests/oracle)), which shares no code with the library;");
    line("[visibility.md](visibility.md) defines what it is. Asked are\n");
    line("- plumb: {} on every instruction set of the machine ({})", methods, targets);
    bool has_peers = false;
    for (const Answerer& answerer : report_.answerers) {
      if (!answerer.is_peer()) continue;
      line("- `{}`: {}; {}", answerer.method, answerer.version, answerer.remark);
      has_peers = true;
    }
    if (has_peers) {
      line(
          "\nA peer promises other things: which of two surfaces in one place it sees is its own affair, "
          "and");
      line("so counted apart.");
    }
    line("");
    line(
        "- **wrong ids**: another triangle than the definition's, or one where there is none, or none where");
    line("  there is one; the sum of the next four.");
    line("- **lost**, **extra**: nothing seen where something is, something where nothing is.");
    line("- **other surface**: a triangle whose plane is not at the exact depth there, be it by one float.");
    line("- **same depth**: another triangle, whose plane is at the exact depth.");
    line("- **other depths**: on the right surface, a depth that is not the exact one rounded once to the");
    line("  nearest float; **ulps** is how many floats the worst of them is off.");
  }

  void overview() {
    const Tally total = report_.plumb_total();
    line("\n## Overview\n");
    line("{} answers of plumb's methods and instruction sets were compared; {} of them differ.\n",
         grouped(total.asked), total.different == 0 ? "none" : grouped(total.different));
    line("For plumb the number of answers, of all methods and instruction sets together, that differ in any");
    line(
        "bit. For a peer two shares of what it was asked: lost, extra or on another surface, and after the "
        "+");
    line("another triangle at the same depth. Empty where it was not asked.\n");
    std::string head = "| case | rays | pixels | plumb |", rule = "|---|--:|--:|--:|";
    for (const Answerer& answerer : report_.answerers) {
      if (!answerer.is_peer()) continue;
      head += " " + answerer.method + " |";
      rule += "--:|";
    }
    line("{}\n{}", head, rule);
    for (const CaseResult& result : report_.cases) {
      std::string row =
          fmt::format("| [{0}](#{0}) | {1} | {2} | {3} |", result.hard_case->name, grouped(result.rays.count),
                      grouped(result.pixels.count), grouped(plumb_differences(result, report_.answerers)));
      for (std::size_t i = 0; i < report_.answerers.size(); ++i) {
        if (!report_.answerers[i].is_peer()) continue;
        const Tally tally = both(result, i);
        row += fmt::format(" {} |", shares(tally));
      }
      line("{}", row);
    }
  }

  void details(const CaseResult& result) {
    line("\n### {}\n", result.hard_case->name);
    line("{}\n", result.hard_case->built);
    line("*{}*\n", result.hard_case->definition);
    line("{} scenes{}{}.\n", grouped(result.instances), seen("rays", result.rays),
         seen("pixels", result.pixels));
    line("| | asked | wrong ids | lost | extra | other surface | same depth | other depths | ulps |");
    line("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    rows("rays", result.rays);
    rows("pixels", result.pixels);
    for (const std::string& difference : result.differences) line("\n    {}", difference);
  }

  static std::string seen(std::string_view what, const Asked& asked) {
    if (asked.count == 0) return "";
    return fmt::format(", {} {} of which {} see something", grouped(asked.count), what,
                       percentage(asked.seen, asked.count));
  }

  // plumb's methods in one row while none of them is ever wrong.
  void rows(std::string_view what, const Asked& asked) {
    std::string right;
    for (std::size_t i = 0; i < report_.answerers.size(); ++i) {
      const Answerer& answerer = report_.answerers[i];
      const Tally& tally = asked.tallies[i];
      if (answerer.is_peer() || tally.asked == 0) continue;
      if (tally.different != 0) {
        row(fmt::format("{}: {} {}", what, answerer.method, answerer.simd), tally);
      } else if (right.find(answerer.method) == std::string::npos) {
        right.append(right.empty() ? "" : ", ").append(answerer.method);
      }
    }
    if (!right.empty()) {
      Tally none;
      none.asked = asked.count;
      row(fmt::format("{}: {}", what, right), none);
    }
    for (std::size_t i = 0; i < report_.answerers.size(); ++i) {
      if (report_.answerers[i].is_peer() && asked.tallies[i].asked != 0) {
        row(fmt::format("{}: {}", what, report_.answerers[i].method), asked.tallies[i]);
      }
    }
  }

  void row(const std::string& name, const Tally& tally) {
    line("| {} | {} | {} | {} | {} | {} | {} | {} | {} |", name, grouped(tally.asked),
         grouped(tally.wrong_ids), grouped(tally.lost), grouped(tally.extra), grouped(tally.other_surface),
         grouped(tally.same_depth), grouped(tally.other_depths), ulps(tally));
  }

  const HardReport& report_;
  std::string text_;
};

}  // namespace

std::string to_markdown(const HardReport& report) { return Document(report).text(); }

std::string summary(const CaseResult& result, const std::vector<Answerer>& answerers) {
  const std::uint64_t differences = plumb_differences(result, answerers);
  std::string text = fmt::format("{:<24} {:>9} rays {:>10} pixels  plumb {}", result.hard_case->name,
                                 grouped(result.rays.count), grouped(result.pixels.count),
                                 differences == 0 ? std::string("0") : "DIFFERS in " + grouped(differences));
  for (std::size_t i = 0; i < answerers.size(); ++i) {
    const Tally tally = both(result, i);
    if (!answerers[i].is_peer() || tally.asked == 0) continue;
    text += fmt::format("  {} {}", answerers[i].method, shares(tally));
  }
  for (const std::string& difference : result.differences) text += "\n    " + difference;
  return text;
}

}  // namespace plumb::tool
