// A last check before a new file takes its name.
#pragma once

#include <functional>

namespace keeler::files {

/// During its lifetime, each NewFile of this thread calls `check` after it is written and before it takes its name. If
/// `check` throws, no file is left: for instance when the folder was replaced by another meanwhile. Guards nest.
class NamingGuard {
public:
  /// Precondition: check is not empty.
  explicit NamingGuard(std::function<void()> check);
  ~NamingGuard();
  NamingGuard(const NamingGuard&) = delete;
  NamingGuard& operator=(const NamingGuard&) = delete;

  /// Calls the check of this thread's innermost guard, if there is one.
  static void run_check();

private:
  std::function<void()> check_;
  const NamingGuard* outer_;
};

} // namespace keeler::files
