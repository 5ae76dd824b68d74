// A libFuzzer program: PLUMB_FUZZ_READER is a mesh file's extension, or nothing for the methods of seeing.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "fuzz/targets.h"

namespace {

std::string fault_of(std::span<const std::uint8_t> bytes) {
#if defined(PLUMB_FUZZ_READER)
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return plumb::fuzz::fault_of_reader(PLUMB_FUZZ_READER, text);
#else
  return plumb::fuzz::fault_of_methods(bytes);
#endif
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string fault = fault_of({data, size});
  if (fault.empty()) return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}
