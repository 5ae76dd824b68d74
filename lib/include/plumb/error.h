#pragma once

#include <stdexcept>

namespace plumb {

/// The one error type for anything a caller can get wrong. `what()` names the file, line, index or
/// value that is at fault and says what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when a progress callback returned false. What is left of the call's work, if anything, is
/// said where the callback is.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace plumb
