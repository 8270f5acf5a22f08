// Who decides at the last moment whether a new file may take its name.
#pragma once

#include <functional>

namespace keeler {

/// While it lives, each new file of this thread (new_file.hpp) asks `check` when it is written and has not taken its
/// name yet. What that throws leaves no file: a folder that was replaced by another meanwhile gets none.
class NamingGuard {
public:
  explicit NamingGuard(std::function<void()> check);
  ~NamingGuard();
  NamingGuard(const NamingGuard&) = delete;
  NamingGuard& operator=(const NamingGuard&) = delete;

  /// Asks the innermost guard of this thread, if there is one.
  static void ask();

private:
  std::function<void()> check_;
  const NamingGuard* outer_;
};

} // namespace keeler
