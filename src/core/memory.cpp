#include <keeler/core/memory.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/large_blocks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <malloc.h>
#include <sys/resource.h>

namespace keeler {
namespace {

constexpr double address_space = 0x1p47;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Returns the entry `name` (in KiB) of a file of proc(5), in bytes.
double read_kib(const char* file, const std::string& name) {
  std::ifstream text(file);
  for (std::string word; text >> word;)
    if (double kib = 0.0; word == name && text >> kib)
      return 1024.0 * kib;
  return unknown;
}

// Returns the number at the beginning of a file; unknown for "max", a control group without a limit.
double read_number(const std::string& file) {
  std::ifstream text(file);
  double number = 0.0;
  return text >> number ? number : unknown;
}

// Returns the free memory of this process's control group and its ancestors (cgroups(7), version 2); a container sees
// its own group at the root. File caches that can be dropped count as free.
double free_in_groups() {
  std::ifstream text("/proc/self/cgroup");
  std::string line, path;
  while (std::getline(text, line))
    if (line.starts_with("0::"))
      path = line.substr(3);
  double min_free = address_space;
  for (;;) {
    const std::string folder = "/sys/fs/cgroup" + (path == "/" ? std::string() : path);
    const double limit = read_number(folder + "/memory.max"), used = read_number(folder + "/memory.current");
    if (limit >= 0.0 && used >= 0.0) {
      std::ifstream parts(folder + "/memory.stat");
      double droppable = 0.0, bytes = 0.0;
      for (std::string name; parts >> name >> bytes;)
        if (name == "inactive_file" || name == "active_file")
          droppable += bytes;
      min_free = std::min(min_free, std::max(0.0, limit - used + droppable));
    }
    if (path.empty() || path == "/")
      return min_free;
    path.resize(path.rfind('/'));
  }
}

// Returns the memory left below the address space limit.
double free_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return address_space;
  const double used = read_kib("/proc/self/status", "VmSize:");
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - (used >= 0.0 ? used : 0.0));
}

bool user_sets_allocator() {
  for (const char* name :
       {"GLIBC_TUNABLES", "MALLOC_MMAP_MAX_", "MALLOC_MMAP_THRESHOLD_", "MALLOC_TRIM_THRESHOLD_", "MALLOC_TOP_PAD_"})
    if (std::getenv(name))
      return true;
  return false;
}

} // namespace

// Not ru_maxrss of getrusage(2), which includes the process before exec.
double peak_memory() {
  return read_kib("/proc/self/status", "VmHWM:");
}

double available_memory() {
  const double free = read_kib("/proc/meminfo", "MemAvailable:"), swap = read_kib("/proc/meminfo", "SwapFree:");
  const double machine = free >= 0.0 ? free + (swap >= 0.0 ? swap : 0.0) : address_space;
  return std::min({address_space, machine, free_in_groups(), free_address_space()});
}

void require_memory(double bytes, const std::string& what, const std::string& remedy) {
  constexpr double always_allowed = 1e6; // bytes; not worth asking the system
  if (bytes <= always_allowed)
    return;
  const double available = available_memory();
  if (!(bytes <= available))
    throw UsageError(fmt::format("{} needs {} GB of memory, and {} GB are available; {}", what,
                                 format_number(1e-9 * bytes, 3), format_number(1e-9 * available, 3), remedy));
}

std::size_t affordable_size(double count, double bytes_each, const std::string& what, const std::string& remedy) {
  assert(bytes_each >= 0.0);
  const double counted = count >= 0.0 ? count : std::numeric_limits<double>::quiet_NaN();
  require_memory(std::max(1.0, bytes_each) * counted, what, remedy);
  return static_cast<std::size_t>(counted);
}

void keep_freed_memory() {
#ifdef __GLIBC__
  if (user_sets_allocator())
    return;
  mallopt(M_MMAP_MAX, 0);        // all blocks come from the heap,
  mallopt(M_TRIM_THRESHOLD, -1); // which never shrinks
  reuse_large_blocks();
#endif
}

void return_freed_memory() {
#ifdef __GLIBC__
  constexpr int longest_in_heap = 4 << 20, longest_free_end = 4 << 20; // bytes
  if (user_sets_allocator())
    return;
  mallopt(M_MMAP_THRESHOLD, longest_in_heap);
  mallopt(M_TRIM_THRESHOLD, longest_free_end);
  reuse_large_blocks();
#endif
}

} // namespace keeler
