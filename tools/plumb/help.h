#pragma once

#include <string>

namespace plumb::tool {

/// What stands under the options of the tool's own --help, and of a subcommand's.
std::string main_help();
std::string compare_help();
std::string render_help();
std::string info_help();
std::string soak_help();

}  // namespace plumb::tool
