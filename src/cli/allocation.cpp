// The program's operator new, which uses large blocks again (core/large_blocks.hpp). All other blocks are the C
// library's. A library must not decide this for a process, so only the program has it.
#include <keeler/core/large_blocks.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <new>

#include <unistd.h>

namespace {

constexpr std::size_t large_block = std::size_t{1} << 16; // bytes, at least

// A child of fork(2) may only allocate if no other thread of its parent did at that moment (io/child_process.cpp).
struct SharedBlocks {
  std::mutex mutex;
  // twice the machine's memory: addresses cost nothing, and free ranges are of many lengths
  keeler::LargeBlocks blocks{2 * keeler::LargeBlocks::page * static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES))};
};

// Never destroyed: arrays of static lifetime may be freed after all else.
SharedBlocks& shared_blocks() {
  alignas(SharedBlocks) static std::byte place[sizeof(SharedBlocks)];
  static SharedBlocks* const only = new (place) SharedBlocks;
  return *only;
}

// Returns null if there is no memory.
void* allocate(std::size_t bytes, std::size_t alignment) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()))
    return nullptr;
  if (bytes >= large_block && alignment <= keeler::LargeBlocks::page && keeler::large_blocks_are_reused()) {
    SharedBlocks& shared = shared_blocks();
    const std::lock_guard lock(shared.mutex);
    if (void* const block = shared.blocks.take(bytes))
      return block;
  }
  if (alignment <= alignof(std::max_align_t))
    return std::malloc(bytes > 0 ? bytes : 1);
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void* allocate_or_throw(std::size_t bytes, std::size_t alignment) {
  for (;;) {
    if (void* const block = allocate(bytes, alignment))
      return block;
    const std::new_handler free_some = std::get_new_handler();
    if (!free_some)
      throw std::bad_alloc();
    free_some();
  }
}

// Small blocks begin a page by chance, so few of them are looked up.
void release(void* block) {
  if (block && reinterpret_cast<std::uintptr_t>(block) % keeler::LargeBlocks::page == 0) {
    SharedBlocks& shared = shared_blocks();
    const std::lock_guard lock(shared.mutex);
    if (shared.blocks.give_back(block))
      return;
  }
  std::free(block);
}

} // namespace

// The standard's other forms call these.
void* operator new(std::size_t bytes) {
  return allocate_or_throw(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t) noexcept {
  release(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  release(block);
}
