// The commands that compare with rational arithmetic, in a build without GMP: they say so.

#include <string>

#include <fmt/format.h>

#include "commands.h"
#include "plumb/error.h"

namespace plumb::tool {
namespace {

void add(CLI::App& app, const std::string& name, const std::string& description) {
  CLI::App* command = app.add_subcommand(name, description + " (not in this build: GMP was not found)");
  command->allow_extras();
  command->callback([name] {
    throw Error(fmt::format(
        "plumb: {} compares with rational arithmetic, and GMP was not found when plumb was built; "
        "install it (Debian: libgmp-dev) and build again",
        name));
  });
}

}  // namespace

void add_soak_command(CLI::App& app, int&) { add(app, "soak", "Search for a wrong answer"); }
void add_report_command(CLI::App& app, int&) { add(app, "report", "Show how exact plumb is"); }

}  // namespace plumb::tool
