// A run in a separate process: this program, with the arguments of `keeler run` or `keeler resume`. When its parent
// dies, it receives SIGTERM and stops with a checkpoint.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace keeler::batch {

/// The end of a child process.
struct ChildEnd {
  int code = 0;        ///< exit code; 128 + the number of the signal that ended it
  std::string message; ///< its last message to the user, without the name of the program; empty: none
};

class Child {
public:
  /// Starts the process in a new process group, so that signals from the keyboard reach only the parent. Throws Error
  /// when no process can be started.
  explicit Child(const std::vector<std::string>& arguments);

  /// Sends SIGTERM to a child that is still running.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Returns how the child ended, once; none while it runs and after its end was returned.
  std::optional<ChildEnd> end();

  /// Sends SIGTERM. The child stops with a checkpoint after its step; after a second signal, at once.
  void stop();

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  ChildEnd ended_with(int status) const;

  std::unique_ptr<std::FILE, Close> messages_; // standard error of the child, an unnamed file
  pid_t process_ = -1;                         // -1: it has ended
};

} // namespace keeler::batch
