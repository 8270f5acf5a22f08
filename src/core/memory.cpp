#include <keeler/core/memory.hpp>

#include <fstream>
#include <limits>
#include <string>

namespace keeler {

// By proc(5). Not ru_maxrss of getrusage(2), which also counts what the process was before it became this program.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kib = 0.0; word == "VmHWM:" && status >> kib)
      return 1024.0 * kib;
  return std::numeric_limits<double>::quiet_NaN();
}

} // namespace keeler
