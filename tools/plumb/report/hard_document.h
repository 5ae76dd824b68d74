#pragma once

#include <string>

#include "report/hard_run.h"

namespace plumb::tool {

/// docs/hard-cases.md.
std::string to_markdown(const HardReport& report);

/// The report as a JSON object, as docs/tool.md describes it.
std::string to_json(const HardReport& report);

/// For a terminal: one line, how plumb's methods and each peer do at a case.
std::string summary(const CaseResult& result, const std::vector<Answerer>& answerers);

}  // namespace plumb::tool
