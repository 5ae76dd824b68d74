#pragma once

#include <string>

namespace plumb::tool {

/// What stands under the options in a subcommand's --help.
std::string compare_help();
std::string render_help();
std::string info_help();

}  // namespace plumb::tool
