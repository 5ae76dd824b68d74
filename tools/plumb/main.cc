// The command-line tool; docs/tool.md describes it. Standard output holds only what was asked for
// (--json, --help, --version); what is said to people goes to standard error.

#include <exception>
#include <new>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "commands.h"
#include "help.h"
#include "plumb/version.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

/// Says what is wrong, in C's own way, which cannot throw.
int complain(const char* message) noexcept {
  const bool has_prefix = std::strncmp(message, "plumb: ", 7) == 0;
  std::fprintf(stderr, "%s%s\n", has_prefix ? "" : "plumb: ", message);
  return kBadInput;
}

int run(int argc, char** argv) {
  CLI::App app("What does this ray, this camera, see? Exactly, by rays and by triangles.", "plumb");
  app.set_version_flag("--version", "plumb " PLUMB_VERSION);
  app.require_subcommand(1);
  app.footer(main_help());
  int status = kAgree;
  add_compare_command(app, status);
  add_render_command(app, status);
  add_info_command(app, status);
  add_soak_command(app, status);
  add_report_command(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Asking for help or the version is no failure; CLI11 prints either.
    return app.exit(error) == 0 ? kAgree : kBadInput;
  }
  return status;
}

}  // namespace
}  // namespace plumb::tool

int main(int argc, char** argv) {
  try {
    return plumb::tool::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return plumb::tool::complain("out of memory");
  } catch (const std::exception& error) {
    return plumb::tool::complain(error.what());
  }
}
