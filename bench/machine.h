#pragma once

#include <string>

namespace plumb::bench {

/// The processor's name and how many threads it runs; "unknown processor" where the system does not say.
std::string machine_name();
/// How busy the machine is: processes that want to run, averaged over the last minute. Empty where the
/// system does not say.
std::string machine_load();
/// The compiler that built this program.
std::string compiler_name();

}  // namespace plumb::bench
