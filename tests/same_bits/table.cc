#include "same_bits/table.h"

namespace plumb::same_bits {
namespace {

constexpr Row kTable[] = {
#include "same_bits/table.inc"
};

}  // namespace

std::span<const Row> table() { return kTable; }

}  // namespace plumb::same_bits
