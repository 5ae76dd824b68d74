#include "commands.h"
#include "plumb/error.h"

namespace plumb::tool {

void add_soak_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("soak", "Search for a wrong answer (not in this build: GMP was not found)");
  command->allow_extras();
  command->callback([] {
    throw Error(
        "plumb: soak compares with rational arithmetic, and GMP was not found when plumb was built; "
        "install it (Debian: libgmp-dev) and build again");
  });
}

}  // namespace plumb::tool
