#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumb::detail {

/// Arrays of this many bytes and more are put on large pages where the system has them: memory is handed out
/// page by page, which took a quarter of the time of collapsing a large tree, and walks through a tree miss
/// the processor's table of pages less.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// As ::operator new; at large pages' boundaries, if it is worth it.
void* allocate_large(std::size_t bytes, std::align_val_t alignment);
void free_large(void* p, std::size_t bytes, std::align_val_t alignment);

/// Allocates at cache-line boundaries, so that a vector load of any width never splits a line. Without kSet
/// elements that are made without a value have none, for those that are written right after.
template <typename T, bool kSet = true>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  AlignedAllocator() = default;
  template <typename U>
  AlignedAllocator(const AlignedAllocator<U, kSet>&) {}
  template <typename U>
  struct rebind {
    using other = AlignedAllocator<U, kSet>;
  };

  T* allocate(std::size_t n) { return static_cast<T*>(allocate_large(n * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t n) { free_large(p, n * sizeof(T), kAlignment); }
  template <typename U>
  void construct(U* p) {
    if constexpr (kSet) {
      ::new (static_cast<void*>(p)) U();
    } else {
      ::new (static_cast<void*>(p)) U;
    }
  }
  template <typename U, typename First, typename... Rest>
  void construct(U* p, First&& first, Rest&&... rest) {
    ::new (static_cast<void*>(p)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
  }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

template <typename T>
using UnsetVector = std::vector<T, AlignedAllocator<T, false>>;

struct LargeArrayDeleter {
  std::size_t bytes = 0;
  void operator()(void* p) const { free_large(p, bytes, AlignedAllocator<char>::kAlignment); }
};

/// An array of a trivial type, its elements not set.
template <typename T>
using LargeArray = std::unique_ptr<T[], LargeArrayDeleter>;

template <typename T>
LargeArray<T> make_large_array(std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  static_assert(alignof(T) <= static_cast<std::size_t>(AlignedAllocator<char>::kAlignment));
  const LargeArrayDeleter deleter{count * sizeof(T)};
  T* const p = static_cast<T*>(allocate_large(deleter.bytes, AlignedAllocator<char>::kAlignment));
  std::uninitialized_default_construct_n(p, count);  // does nothing
  return LargeArray<T>(p, deleter);
}

}  // namespace plumb::detail
