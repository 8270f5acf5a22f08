// The program's operator new, which uses large blocks again (core/large_blocks.hpp). All other blocks are the C
// library's. A library must not decide this for a process, so only the program has it.
#include <keeler/core/large_blocks.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <new>

#include <pthread.h>
#include <unistd.h>

namespace {

constexpr std::size_t large_block = std::size_t{1} << 16; // bytes, at least

std::size_t memory_of_machine() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  return pages > 0 ? static_cast<std::size_t>(pages) * keeler::LargeBlocks::page : 0;
}

struct SharedBlocks {
  std::mutex mutex;
  std::size_t most = memory_of_machine();
  keeler::LargeBlocks blocks{2 * most}; // addresses cost nothing, and free ranges are of many lengths

  // Returns null if there is no place, or more would be in use than the machine has: the C library decides then.
  void* take(std::size_t bytes) {
    const std::lock_guard lock(mutex);
    return bytes <= most && blocks.used() <= most - bytes ? blocks.take(bytes) : nullptr;
  }
};

std::atomic<SharedBlocks*> made = nullptr; // once there has been a large block

// Never destroyed: arrays of static lifetime may be freed after all else. A child of fork(2) gets them unlocked.
SharedBlocks& shared_blocks() {
  alignas(SharedBlocks) static std::byte place[sizeof(SharedBlocks)];
  static SharedBlocks* const only = [] {
    auto* const blocks = new (place) SharedBlocks;
    made.store(blocks, std::memory_order_release);
    pthread_atfork([] { made.load()->mutex.lock(); }, [] { made.load()->mutex.unlock(); },
                   [] { made.load()->mutex.unlock(); });
    return blocks;
  }();
  return *only;
}

// Returns null if there is no memory.
void* allocate(std::size_t bytes, std::size_t alignment) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()))
    return nullptr;
  if (bytes >= large_block && alignment <= keeler::LargeBlocks::page && keeler::large_blocks_are_reused())
    if (void* const block = shared_blocks().take(bytes))
      return block;
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
  SharedBlocks* const shared = made.load(std::memory_order_acquire);
  if (shared && block && reinterpret_cast<std::uintptr_t>(block) % keeler::LargeBlocks::page == 0) {
    const std::lock_guard lock(shared->mutex);
    if (shared->blocks.give_back(block))
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
