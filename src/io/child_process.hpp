// Isolates work that may crash, never end or exhaust memory in a child process: HDF5 reading a file without a seal. The
// result returns as plain bytes through a pipe (parcel.hpp), so a failure of the child cannot harm this process.
// The child is a fork: it uses no threads and exits without clean-up.
#pragma once

#include "parcel.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace keeler {

/// Resource limits of a child.
struct ChildLimits {
  std::size_t memory = 0; ///< bytes beyond the parent's; also the most that it may send
  unsigned cpu_s = 0;     ///< processor time, s
  unsigned wall_s = 0;    ///< wall time, s
};

/// Returns generous limits for reading a file of `file_bytes`: far more than an undamaged file needs.
ChildLimits limits_for(std::size_t file_bytes);

/// Runs `work` in a child process: it computes the result and returns a function that sends it; `take` receives it in
/// this process. An Error that `work` throws is rethrown here, as UsageError or IoError. Throws IoError "cannot WHAT:
/// reason" when the child crashes or exceeds its limits; Interrupted. Precondition: all limits are > 0.
void run_in_child(const std::string& what, const ChildLimits& limits,
                  const std::function<std::function<void(Sender&)>()>& work,
                  const std::function<void(Receiver&)>& take);

/// Returns read(), called in a child process.
template<class Result>
Result read_in_child(const std::string& what, const ChildLimits& limits, const std::function<Result()>& read) {
  Result result;
  run_in_child(
      what, limits, [&]() -> std::function<void(Sender&)> { return [made = read()](Sender& sender) { sender(made); }; },
      [&](Receiver& receiver) { receiver(result); });
  return result;
}

} // namespace keeler
