// Tries out work that may crash, never end or exhaust memory in a child process: HDF5 reading a file without a seal.
// What succeeds there is done again in this process, on the same bytes. The child is a fork: it uses no threads and
// exits without clean-up.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace keeler::io {

/// Resource limits of a child.
struct ChildLimits {
  std::size_t memory = 0; ///< bytes beyond the parent's
  unsigned cpu_s = 0;     ///< processor time, s
  unsigned wall_s = 0;    ///< wall time, s
};

/// Returns generous limits for reading a file of `file_bytes`: far more than an undamaged file needs.
ChildLimits limits_for(std::size_t file_bytes);

/// Runs `work` in a child process, and returns when it has succeeded there. An Error that it throws is rethrown here,
/// as UsageError or IoError. Throws IoError "cannot WHAT: reason" when the child crashes or exceeds its limits;
/// Interrupted. Precondition: all limits are > 0.
void try_in_child(const std::string& what, const ChildLimits& limits, const std::function<void()>& work);

/// Returns read(), after it has succeeded in a child process.
template<class Read> auto read_after_trial(const std::string& what, const ChildLimits& limits, const Read& read) {
  try_in_child(what, limits, [&] { read(); });
  return read();
}

} // namespace keeler::io
