// A library that is loaded before the C++ library (LD_PRELOAD) and lets `operator new` fail when a test says so, by
// fail_allocations().
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> calls = 0, first = 0, last = 0; // those from the first to the last fail; none when 0

void* allocated(std::size_t size, std::size_t alignment) {
  const long call = ++calls;
  if (call >= first && call <= last)
    return nullptr;
  void* memory = nullptr;
  return posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size == 0 ? 1 : size) == 0
             ? memory
             : nullptr;
}

void* allocated_or_thrown(std::size_t size, std::size_t alignment) {
  if (void* const memory = allocated(size, alignment))
    return memory;
  throw std::bad_alloc();
}

} // namespace

extern "C" {

/// Restarts the count at 1; the calls from `from` to `to` fail.
void fail_allocations(long from, long to) {
  calls = 0;
  first = from;
  last = to;
}

/// Calls since then.
long allocations() {
  return calls;
}

} // extern "C"

void* operator new(std::size_t size) {
  return allocated_or_thrown(size, 1);
}
void* operator new[](std::size_t size) {
  return allocated_or_thrown(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocated_or_thrown(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocated_or_thrown(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocated(size, 1);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocated(size, 1);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
