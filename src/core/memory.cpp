#include <keeler/core/memory.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include <sys/resource.h>

namespace keeler {
namespace {

constexpr double address_space = 0x1p47;
constexpr double nothing_said = std::numeric_limits<double>::quiet_NaN();

// The number in KiB behind a name in a file of proc(5), in bytes.
double read_kib(const char* file, const std::string& name) {
  std::ifstream text(file);
  for (std::string word; text >> word;)
    if (double kib = 0.0; word == name && text >> kib)
      return 1024.0 * kib;
  return nothing_said;
}

// The number that a file begins with; a control group without a limit says "max".
double read_number(const std::string& file) {
  std::ifstream text(file);
  double number = 0.0;
  return text >> number ? number : nothing_said;
}

// What is left of a control group and of those above it (cgroups(7), version 2), whose files a container sees at the
// top. Caches of files that can be dropped count as free.
double left_in_groups() {
  std::ifstream text("/proc/self/cgroup");
  std::string line, path;
  while (std::getline(text, line))
    if (line.starts_with("0::"))
      path = line.substr(3);
  double least = address_space;
  for (;;) {
    const std::string folder = "/sys/fs/cgroup" + (path == "/" ? std::string() : path);
    const double limit = read_number(folder + "/memory.max"), used = read_number(folder + "/memory.current");
    if (limit >= 0.0 && used >= 0.0) {
      std::ifstream parts(folder + "/memory.stat");
      double droppable = 0.0, bytes = 0.0;
      for (std::string name; parts >> name >> bytes;)
        if (name == "inactive_file" || name == "active_file")
          droppable += bytes;
      least = std::min(least, std::max(0.0, limit - used + droppable));
    }
    if (path.empty() || path == "/")
      return least;
    path.resize(path.rfind('/'));
  }
}

double left_below_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return address_space;
  const double used = read_kib("/proc/self/status", "VmSize:");
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - (used >= 0.0 ? used : 0.0));
}

} // namespace

// Not ru_maxrss of getrusage(2), which also counts what the process was before it became this program.
double peak_memory() {
  return read_kib("/proc/self/status", "VmHWM:");
}

double available_memory() {
  const double free = read_kib("/proc/meminfo", "MemAvailable:"), swap = read_kib("/proc/meminfo", "SwapFree:");
  const double machine = free >= 0.0 ? free + (swap >= 0.0 ? swap : 0.0) : address_space;
  return std::min({address_space, machine, left_in_groups(), left_below_limit()});
}

void require_memory(double bytes, const std::string& what, const std::string& remedy) {
  constexpr double always_there = 1e6; // so little is not worth a look at the system
  if (bytes <= always_there)
    return;
  const double left = available_memory();
  if (!(bytes <= left))
    throw UsageError(fmt::format("{} needs {} GB of memory, and {} GB can be had here; {}", what,
                                 format_number(1e-9 * bytes, 3), format_number(1e-9 * left, 3), remedy));
}

std::size_t affordable_size(double count, double bytes_each, const std::string& what, const std::string& remedy) {
  const double counted = count >= 0.0 ? count : std::numeric_limits<double>::quiet_NaN();
  require_memory(std::max(1.0, bytes_each) * counted, what, remedy);
  return static_cast<std::size_t>(counted);
}

} // namespace keeler
