#pragma once

#include <functional>
#include <string>

namespace plumb::tool {

/// A progress callback that draws a bar on standard error and wipes it at the end; an empty one
/// where standard error is no terminal.
std::function<bool(double)> progress_bar(const std::string& label);

}  // namespace plumb::tool
