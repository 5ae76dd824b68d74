#pragma once

#include <filesystem>
#include <string>

namespace plumb::test {

/// A folder of its own for one test, removed with what it holds.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct ToolRun {
  int status;            ///< of the process; -1 when it did not exit by itself
  std::string out, err;  ///< what it wrote to standard output and standard error
};

/// Runs the built tool with arguments as a shell would split them. `redirect` goes after them, such as
/// "> /dev/full".
ToolRun run_tool(const std::string& arguments, const std::string& redirect = "");

std::string read_text(const std::filesystem::path& path);

}  // namespace plumb::test
