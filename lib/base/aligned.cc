#include "base/aligned.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace plumb::detail {

namespace {

// Smaller arrays would leave too much of their last page unused.
bool is_large(std::size_t bytes) { return bytes >= 2 * kLargePage; }

constexpr std::align_val_t kPageAlignment{kLargePage};

}  // namespace

void* allocate_large(std::size_t bytes, std::align_val_t alignment) {
  if (!is_large(bytes)) return ::operator new(bytes, alignment);
  void* const p = ::operator new(bytes, kPageAlignment);
#ifdef __linux__
  // A hint; without large pages small ones do. The rest behind the last whole page keeps to small ones.
  ::madvise(p, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
#endif
  return p;
}

void free_large(void* p, std::size_t bytes, std::align_val_t alignment) {
  ::operator delete(p, is_large(bytes) ? kPageAlignment : alignment);
}

}  // namespace plumb::detail
