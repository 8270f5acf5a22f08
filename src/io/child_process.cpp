#include "child_process.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/large_blocks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler::io {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

using Clock = std::chrono::steady_clock;

constexpr char endless[] = "reading it does not come to an end, so it is damaged; use another copy";

// First byte of an answer; a message follows, but for a success.
enum Outcome : char { has_succeeded = 's', has_usage_error = 'u', has_io_error = 'i', has_fault = 'f' };

void lower_limit(decltype(RLIMIT_CPU) resource, rlim_t limit) {
  rlimit now = {};
  getrlimit(resource, &now);
  now.rlim_cur = std::min({now.rlim_cur, now.rlim_max, limit});
  setrlimit(resource, &now);
}

// Returns the size of this process's address space in bytes; 0 if unknown.
std::size_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1)
      pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Sets signals, streams and limits of the child. Only the parent reacts to the keyboard; the child ends with its parent
// or when its limits are exceeded, and prints nothing.
void isolate_child(const ChildLimits& limits, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)
    _exit(1);
  for (const int ignored : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2})
    std::signal(ignored, SIG_IGN);
  for (const int deadly : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE})
    std::signal(deadly, SIG_DFL);
  const int null_device = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2(null_device, stream);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, limits.cpu_s);
  stop_reusing_large_blocks(); // their addresses are there already
  const std::size_t used = address_space();
  if (!sanitized && used > 0) // sanitizers reserve terabytes of addresses
    lower_limit(RLIMIT_AS, used + limits.memory);
}

// Returns the outcome of the work, and the message of what it throws.
std::string answer_of(const std::function<void()>& work) {
  try {
    work();
    return {has_succeeded};
  } catch (const Error& error) {
    return std::string(1, error.code() == ExitCode::usage ? has_usage_error : has_io_error) + error.what();
  } catch (const std::bad_alloc&) {
    return std::string(1, has_fault) + "it takes more memory than there is";
  } catch (...) {
    return std::string(1, has_fault) + error_at_hand().what();
  }
}

[[noreturn]] void run_child(int descriptor, const std::function<void()>& work) {
  const std::string answer = answer_of(work);
  const ssize_t written = write(descriptor, answer.data(), answer.size()); // signals are ignored, so it is complete
  _exit(written == static_cast<ssize_t>(answer.size()) ? 0 : 1);
}

/// Owns a child process; the destructor kills it.
class ChildProcess {
public:
  explicit ChildProcess(pid_t id) : id_(id) { assert(id > 0); }
  ~ChildProcess() {
    if (id_ > 0) {
      kill(id_, SIGKILL);
      wait();
    }
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits for its end and returns the reason for a message. Precondition: not called before.
  std::string end() {
    assert(id_ > 0);
    const int status = wait();
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
      return endless;
    const std::string how = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "it ends without an answer";
    return fmt::format("the library breaks on it ({}), so it is damaged; use another copy", how);
  }

private:
  int wait() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

  pid_t id_;
};

class PipeEnd {
public:
  explicit PipeEnd(int descriptor) : descriptor_(descriptor) {}
  ~PipeEnd() { close(); }
  PipeEnd(const PipeEnd&) = delete;
  PipeEnd& operator=(const PipeEnd&) = delete;
  int descriptor() const { return descriptor_; }
  void close() {
    if (descriptor_ >= 0)
      ::close(std::exchange(descriptor_, -1));
  }

private:
  int descriptor_;
};

// Reads a pipe to its end; empty if nothing was written. Throws IoError at the deadline, Interrupted.
std::string read_answer(int descriptor, Clock::time_point deadline) {
  using std::chrono::milliseconds;
  constexpr std::size_t longest = std::size_t{1} << 20;
  std::string answer;
  std::array<char, 4096> piece{};
  while (answer.size() < longest) {
    throw_if_interrupted();
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now()).count();
    if (left <= 0)
      throw IoError(endless);
    pollfd ready = {.fd = descriptor, .events = POLLIN, .revents = 0};
    if (poll(&ready, 1, static_cast<int>(std::min<milliseconds::rep>(left, 1000))) <= 0)
      continue;
    const ssize_t got = read(descriptor, piece.data(), piece.size());
    if (got == 0)
      break;
    if (got > 0)
      answer.append(piece.data(), static_cast<std::size_t>(got));
    else if (errno != EINTR)
      throw IoError(fmt::format("a pipe failed: {}", std::strerror(errno)));
  }
  return answer;
}

} // namespace

ChildLimits limits_for(std::size_t file_bytes) {
  const auto megabytes = static_cast<unsigned>(file_bytes >> 20);
  return {.memory = (std::size_t{1} << 30) + 16 * file_bytes, .cpu_s = 20 + megabytes, .wall_s = 60 + 3 * megabytes};
}

void try_in_child(const std::string& what, const ChildLimits& limits, const std::function<void()>& work) {
  assert(limits.memory > 0 && limits.cpu_s > 0 && limits.wall_s > 0);
  const auto fail = [&](const std::string& reason) { throw IoError(fmt::format("cannot {}: {}", what, reason)); };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    fail(fmt::format("no pipe ({})", std::strerror(errno)));
  const PipeEnd out(ends[0]);
  PipeEnd in(ends[1]);
  const pid_t parent = getpid(), id = fork();
  if (id < 0)
    fail(fmt::format("no process ({})", std::strerror(errno)));
  if (id == 0) {
    isolate_child(limits, parent);
    run_child(in.descriptor(), work);
  }
  in.close();
  ChildProcess child(id);
  std::string answer;
  try {
    answer = read_answer(out.descriptor(), Clock::now() + std::chrono::seconds(limits.wall_s));
  } catch (const IoError& reason) {
    fail(reason.what());
  }
  if (answer.empty())
    fail(child.end());
  const std::string message = answer.substr(1);
  if (answer[0] == has_usage_error)
    throw UsageError(message);
  if (answer[0] == has_io_error)
    throw IoError(message);
  if (answer[0] != has_succeeded)
    fail(message);
}

} // namespace keeler::io
