#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb::tool {

// What a person writes on the command line, read strictly. Each throws plumb::Error that names the
// option, the text and what was expected.

/// "X,Y,Z": finite decimal numbers, each rounded once to the nearest float.
glm::vec3 parse_vec3(std::string_view option, std::string_view text);

/// "WxH": pixels, each side 1 to 65535 and at most 2^28 pixels in all.
std::pair<int, int> parse_size(std::string_view option, std::string_view text);

/// Refuses a negative number of --threads.
void check_threads(int threads);

/// The parts of a list between commas; an empty text is one empty part.
std::vector<std::string> split_list(std::string_view text);

}  // namespace plumb::tool
