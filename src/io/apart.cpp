#include "apart.hpp"

#include <keeler/core/error_at_hand.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler {
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

using Work = std::function<std::function<void(Sender&)>()>;

// How a parcel begins: the result follows, or a message.
enum Kind : std::uint8_t { has_result, has_usage_error, has_io_error, has_fault };

void lower_limit(decltype(RLIMIT_CPU) resource, rlim_t limit) {
  rlimit now = {};
  getrlimit(resource, &now);
  now.rlim_cur = std::min({now.rlim_cur, now.rlim_max, limit});
  setrlimit(resource, &now);
}

// Pages of this process, in bytes; 0 where the system does not tell.
std::size_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1)
      pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Its parent alone heeds the keyboard, and ends it by dying or by losing patience. It says nothing to the user.
void become_apart(const ApartLimits& limits, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)
    _exit(1);
  for (const int heard : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2})
    std::signal(heard, SIG_IGN);
  for (const int deadly : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE})
    std::signal(deadly, SIG_DFL);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2(nothing, stream);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, limits.cpu_s);
  const std::size_t have = address_space();
  if (!sanitized && have > 0) // sanitizers reserve terabytes of addresses
    lower_limit(RLIMIT_AS, have + limits.memory);
}

[[noreturn]] void live_apart(int descriptor, const Work& work) {
  Sender sender(descriptor);
  try {
    const std::function<void(Sender&)> send = work();
    sender(std::uint8_t{has_result});
    send(sender);
  } catch (const Error& error) {
    sender(std::uint8_t{error.code() == ExitCode::usage ? has_usage_error : has_io_error}, std::string(error.what()));
  } catch (const std::bad_alloc&) {
    sender(std::uint8_t{has_fault}, std::string("it takes more memory than there is"));
  } catch (...) {
    sender(std::uint8_t{has_fault}, std::string(error_at_hand().what()));
  }
  sender.flush();
  _exit(0);
}

/// A child, which does not outlive this.
class Process {
public:
  explicit Process(pid_t id) : id_(id) {}
  ~Process() {
    if (id_ > 0) {
      kill(id_, SIGKILL);
      wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// How it ended, in words.
  std::string end() {
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

class End {
public:
  explicit End(int descriptor) : descriptor_(descriptor) {}
  ~End() { close(); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  int descriptor() const { return descriptor_; }
  void close() {
    if (descriptor_ >= 0)
      ::close(std::exchange(descriptor_, -1));
  }

private:
  int descriptor_;
};

// What came of it: the result is taken, or there is a message.
struct Answer {
  std::uint8_t kind = has_result;
  std::string message;
};

Answer receive(Receiver& receiver, const std::function<void(Receiver&)>& take) {
  Answer answer;
  receiver(answer.kind);
  if (answer.kind == has_result)
    take(receiver);
  else
    receiver(answer.message);
  return answer;
}

} // namespace

ApartLimits limits_for(std::size_t file_bytes) {
  const auto megabytes = static_cast<unsigned>(file_bytes >> 20);
  return {.memory = (std::size_t{1} << 30) + 16 * file_bytes, .cpu_s = 20 + megabytes, .wall_s = 60 + 3 * megabytes};
}

void run_apart(const std::string& what, const ApartLimits& limits,
               const std::function<std::function<void(Sender&)>()>& work, const std::function<void(Receiver&)>& take) {
  const auto fail = [&](const std::string& reason) { throw IoError(fmt::format("cannot {}: {}", what, reason)); };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    fail(fmt::format("no pipe ({})", std::strerror(errno)));
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20); // fewer turns between the two; the default will do
  const End out(ends[0]);
  End in(ends[1]);
  const pid_t parent = getpid(), id = fork();
  if (id < 0)
    fail(fmt::format("no process ({})", std::strerror(errno)));
  if (id == 0) {
    become_apart(limits, parent);
    live_apart(in.descriptor(), work);
  }
  in.close();
  Process child(id);
  Receiver receiver(out.descriptor(), limits.memory,
                    std::chrono::steady_clock::now() + std::chrono::seconds(limits.wall_s));
  Answer answer;
  try {
    answer = receive(receiver, take);
  } catch (const ParcelEnds&) {
    fail(child.end());
  } catch (const IoError& fault) {
    fail(fault.what());
  }
  if (answer.kind == has_usage_error)
    throw UsageError(answer.message);
  if (answer.kind == has_io_error)
    throw IoError(answer.message);
  if (answer.kind != has_result)
    fail(answer.message);
}

} // namespace keeler
