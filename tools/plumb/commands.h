#pragma once

#include <CLI/CLI.hpp>

namespace plumb::tool {

// One function a subcommand, each in its own file. It adds the subcommand, which does its work when
// the command line is parsed and leaves the process's exit status in `status`. Bad input is thrown as
// plumb::Error.
void add_compare_command(CLI::App& app, int& status);
void add_info_command(CLI::App& app, int& status);
void add_render_command(CLI::App& app, int& status);
void add_soak_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);

}  // namespace plumb::tool
