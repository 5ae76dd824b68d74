#include "tool/run_tool.h"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace plumb::test {

TempFolder::TempFolder() {
  static std::atomic<int> count = 0;
  const std::string name = "plumb-tool-test." + std::to_string(getpid()) + "." + std::to_string(count++);
  path_ = std::filesystem::temp_directory_path() / name;
  std::filesystem::create_directories(path_);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

ToolRun run_tool(const std::string& arguments, const std::string& redirect) {
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  const std::string err = (folder / "err").string();
  const std::string command =
      "'" PLUMB_TOOL "' " + arguments + " > '" + out + "' 2> '" + err + "' < /dev/null " + redirect;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

}  // namespace plumb::test
