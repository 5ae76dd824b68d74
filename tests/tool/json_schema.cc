#include "tool/json_schema.h"

#include <regex.h>

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>

namespace plumb::test {
namespace {

// POSIX's extended expressions, for GCC 12 warns of its own <regex> under sanitizers.
bool matches(const std::string& text, const std::string& pattern) {
  regex_t expression;
  if (regcomp(&expression, pattern.c_str(), REG_EXTENDED | REG_NOSUB) != 0) return false;
  const bool found = regexec(&expression, text.c_str(), 0, nullptr, 0) == 0;
  regfree(&expression);
  return found;
}

using nlohmann::json;

struct Check {
  const json& root;
  const json& schema;  // the one that holds the keyword
  const json& value;
  const std::string& place;
  std::vector<std::string>& errors;

  void error(const std::string& what) const { errors.push_back(place + ": " + what); }
  void check(const json& other_schema, const json& other_value, const std::string& other_place) const {
    for (std::string& found : schema_errors(root, other_schema, other_value, other_place)) {
      errors.push_back(std::move(found));
    }
  }
};

bool is_whole(const json& value) {
  return value.is_number_integer() || (value.is_number() && value == value.get<std::int64_t>());
}

bool has_type(const json& value, const std::string& type) {
  if (type == "integer") return is_whole(value);
  if (type == "number") return value.is_number();
  return type == value.type_name();
}

void check_type(const Check& c, const json& type) {
  const json types = type.is_array() ? type : json::array({type});
  const bool fits = std::any_of(types.begin(), types.end(),
                                [&](const json& one) { return has_type(c.value, one.get<std::string>()); });
  if (!fits) c.error(c.value.dump() + " is not of type " + type.dump());
}

void check_reference(const Check& c, const json& reference) {
  const json::json_pointer pointer(reference.get<std::string>().substr(1));  // behind the #
  c.check(c.root.at(pointer), c.value, c.place);
}

void check_enum(const Check& c, const json& allowed) {
  if (std::find(allowed.begin(), allowed.end(), c.value) == allowed.end()) {
    c.error(c.value.dump() + " is none of " + allowed.dump());
  }
}

void check_one_of(const Check& c, const json& schemas) {
  const auto fitting = std::count_if(schemas.begin(), schemas.end(), [&](const json& schema) {
    return schema_errors(c.root, schema, c.value, c.place).empty();
  });
  if (fitting != 1) c.error("fits " + std::to_string(fitting) + " schemas of oneOf");
}

void check_required(const Check& c, const json& names) {
  if (!c.value.is_object()) return;
  for (const json& name : names) {
    if (!c.value.contains(name)) c.error("lacks " + name.dump());
  }
}

void check_properties(const Check& c, const json& properties) {
  if (!c.value.is_object()) return;
  for (const auto& [name, schema] : properties.items()) {
    if (c.value.contains(name)) c.check(schema, c.value.at(name), c.place + "/" + name);
  }
}

void check_other_properties(const Check& c, const json& schema) {
  if (!c.value.is_object()) return;
  const json known = c.schema.value("properties", json::object());
  for (const auto& [name, value] : c.value.items()) {
    if (known.contains(name)) continue;
    if (schema == false) {
      c.error("has " + json(name).dump() + " too");
    } else {
      c.check(schema, value, c.place + "/" + name);
    }
  }
}

void check_items(const Check& c, const json& schema) {
  if (!c.value.is_array()) return;
  for (std::size_t i = 0; i < c.value.size(); ++i) {
    c.check(schema, c.value[i], c.place + "/" + std::to_string(i));
  }
}

void check_pattern(const Check& c, const json& pattern) {
  if (!c.value.is_string()) return;
  if (!matches(c.value.get<std::string>(), pattern.get<std::string>())) {
    c.error(c.value.dump() + " does not match " + pattern.dump());
  }
}

// A keyword that limits a number, or how many items an array has.
std::function<void(const Check&, const json&)> limit(bool of_items, bool (*is_within)(double, double)) {
  return [=](const Check& c, const json& bound) {
    if (of_items ? !c.value.is_array() : !c.value.is_number()) return;
    const double measure = of_items ? static_cast<double>(c.value.size()) : c.value.get<double>();
    if (!is_within(measure, bound.get<double>()))
      c.error(std::to_string(measure) + " is beyond " + bound.dump());
  };
}

const std::map<std::string, std::function<void(const Check&, const json&)>>& keywords() {
  const auto ignore = [](const Check&, const json&) {};
  const auto at_least = [](double value, double bound) { return value >= bound; };
  const auto at_most = [](double value, double bound) { return value <= bound; };
  const auto above = [](double value, double bound) { return value > bound; };
  static const std::map<std::string, std::function<void(const Check&, const json&)>> kKeywords = {
      {"$schema", ignore},
      {"$defs", ignore},
      {"title", ignore},
      {"description", ignore},
      {"$ref", check_reference},
      {"type", check_type},
      {"enum", check_enum},
      {"oneOf", check_one_of},
      {"required", check_required},
      {"properties", check_properties},
      {"additionalProperties", check_other_properties},
      {"items", check_items},
      {"pattern", check_pattern},
      {"minItems", limit(true, at_least)},
      {"maxItems", limit(true, at_most)},
      {"minimum", limit(false, at_least)},
      {"maximum", limit(false, at_most)},
      {"exclusiveMinimum", limit(false, above)}};
  return kKeywords;
}

}  // namespace

std::vector<std::string> schema_errors(const json& root, const json& schema, const json& value,
                                       const std::string& place) {
  std::vector<std::string> errors;
  for (const auto& [keyword, argument] : schema.items()) {
    const auto check = keywords().find(keyword);
    if (check == keywords().end())
      throw std::runtime_error("'" + keyword + "' is not known to this validator");
    check->second({root, schema, value, place, errors}, argument);
  }
  return errors;
}

}  // namespace plumb::test
