#pragma once

#include <span>
#include <string>

#include "soak/shrink.h"

namespace plumb::soak {

/// A doctest test case in C++ that shows the difference, with the oracle's answer as what is to be. It needs
/// <doctest/doctest.h>, <plumb/plumb.h>, <cmath> and `using namespace plumb`.
std::string test_to_paste(const Shrunk& shrunk, std::span<const Subject> subjects);

}  // namespace plumb::soak
