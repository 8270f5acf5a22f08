// A run as a process of its own: this program, with the arguments of `keeler run` or `keeler resume`. When the process
// that started it dies, it stops as on TERM, with a checkpoint.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace keeler {

/// How a child ended.
struct ChildEnd {
  int code = 0;        ///< exit code; 128 + the signal when a signal ended it
  std::string message; ///< its last message to the user, without the name of the program; empty: none
};

class Child {
public:
  /// Starts it in a process group of its own, so that the keyboard's signals reach its parent alone. Throws Error when
  /// the system has no process left.
  explicit Child(const std::vector<std::string>& arguments);

  /// A child that is still alive is asked to stop.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// None while it lives, and once it was told.
  std::optional<ChildEnd> end();

  /// Asks it to stop: the first time with a checkpoint after its step, the second time at once.
  void stop();

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  ChildEnd ended_with(int status) const;

  std::unique_ptr<std::FILE, Close> messages_; // its standard error, a file without a name
  pid_t process_ = -1;                         // -1: it has ended
};

} // namespace keeler
