#include <cstdint>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tool/run_tool.h"

using plumb::test::run_tool;
using plumb::test::ToolRun;

TEST_SUITE_BEGIN("tool: soak");

TEST_CASE("soak compares for as long as it is told and says how much") {
  const ToolRun run = run_tool("soak --seconds 0.5 --seed 3 --threads 2 --json");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const auto json = nlohmann::json::parse(run.out);
  CHECK(json.at("agree") == true);
  CHECK(json.at("difference").is_null());
  CHECK(json.at("seed") == 3);
  CHECK(json.at("seconds").get<double>() >= 0.5);
  CHECK(json.at("instances").get<int>() > 0);
  CHECK(json.at("rays").get<int>() > 0);
  std::int64_t rays = 0;
  for (const auto& kind : json.at("kinds")) rays += kind.at("rays").get<std::int64_t>();
  CHECK(rays == json.at("rays").get<std::int64_t>());
  CHECK(json.at("subjects").size() >= 5);
  CHECK(run.err.find("no answer differs from the oracle's") != std::string::npos);
}

TEST_CASE("a time or a number of threads that makes no sense ends in status 2") {
  CHECK(run_tool("soak --seconds 0").status == 2);
  CHECK(run_tool("soak --seconds nan").status == 2);
  CHECK(run_tool("soak --threads -1").status == 2);
  CHECK(run_tool("soak builtin:grid").status == 2);
}

TEST_SUITE_END();
