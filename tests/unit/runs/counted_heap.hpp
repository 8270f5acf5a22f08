// Counts the bytes that the whole program has allocated by new and not yet deleted. Include it in only one source file
// of an executable: it replaces the allocation functions.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace keeler::test {

inline std::atomic<std::int64_t> bytes_held{0};

/// Returns null when there is no memory. The size of a block is stored directly before it.
inline void* try_to_allocate(std::size_t size, std::size_t alignment) noexcept {
  const std::size_t head = std::max(alignment, alignof(std::max_align_t));
  void* const whole = std::aligned_alloc(head, (size + 2 * head - 1) / head * head);
  if (!whole)
    return nullptr;
  std::byte* const block = static_cast<std::byte*>(whole) + head;
  std::memcpy(block - sizeof size, &size, sizeof size);
  bytes_held += static_cast<std::int64_t>(size);
  return block;
}

inline void* allocate_counted(std::size_t size, std::size_t alignment) {
  void* const block = try_to_allocate(size, alignment);
  if (!block)
    throw std::bad_alloc();
  return block;
}

inline void free_counted(void* block, std::size_t alignment) noexcept {
  if (!block)
    return;
  std::size_t size = 0;
  std::memcpy(&size, static_cast<std::byte*>(block) - sizeof size, sizeof size);
  bytes_held -= static_cast<std::int64_t>(size);
  std::free(static_cast<std::byte*>(block) - std::max(alignment, alignof(std::max_align_t)));
}

} // namespace keeler::test

void* operator new(std::size_t size) {
  return keeler::test::allocate_counted(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return keeler::test::allocate_counted(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return keeler::test::try_to_allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return keeler::test::try_to_allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept {
  keeler::test::free_counted(block, 1);
}
void operator delete(void* block, std::size_t) noexcept {
  keeler::test::free_counted(block, 1);
}
void operator delete(void* block, std::align_val_t alignment) noexcept {
  keeler::test::free_counted(block, static_cast<std::size_t>(alignment));
}
void operator delete(void* block, std::size_t, std::align_val_t alignment) noexcept {
  keeler::test::free_counted(block, static_cast<std::size_t>(alignment));
}
