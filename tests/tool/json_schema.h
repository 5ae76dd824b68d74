#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace plumb::test {

/// What is wrong with `value` by the schema, an error a line with the place in the value; nothing when it is
/// valid. Knows the part of JSON Schema 2020-12 that docs/tool.schema.json is written in, with references
/// into `root`; throws std::runtime_error for a keyword that it does not know, so that none goes unchecked.
std::vector<std::string> schema_errors(const nlohmann::json& root, const nlohmann::json& schema,
                                       const nlohmann::json& value, const std::string& place = "");

}  // namespace plumb::test
