// Work in a child process, for what may break, not end or eat the memory: HDF5 on the structures of a file that nobody
// vouches for. The result comes back as plain bytes (parcel.hpp), so nothing that happens to the child happens here.
// The child is a fork: it uses no threads and leaves without clean-up.
#pragma once

#include "parcel.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace keeler {

/// What a child may take.
struct ApartLimits {
  std::size_t memory = 0; ///< bytes, beside what its parent has; as many it may send
  unsigned cpu_s = 0;
  unsigned wall_s = 0;
};

/// For reading a file of that many bytes: far more than a whole file takes.
ApartLimits limits_for(std::size_t file_bytes);

/// Runs `work` in a child process: it makes the result and returns what sends it, and `take` receives it here. An Error
/// that `work` throws is thrown here, as UsageError or IoError. IoError "cannot WHAT: reason" when the child breaks or
/// exceeds its limits; Interrupted.
void run_apart(const std::string& what, const ApartLimits& limits,
               const std::function<std::function<void(Sender&)>()>& work, const std::function<void(Receiver&)>& take);

/// What `read` returns, read in a child process.
template<class Result>
Result read_apart(const std::string& what, const ApartLimits& limits, const std::function<Result()>& read) {
  Result result;
  run_apart(
      what, limits, [&]() -> std::function<void(Sender&)> { return [made = read()](Sender& sender) { sender(made); }; },
      [&](Receiver& receiver) { receiver(result); });
  return result;
}

} // namespace keeler
