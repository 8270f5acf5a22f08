#include "child.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler::batch {
namespace {

constexpr const char* program = "/proc/self/exe";

// Signals blocked until the new program has installed its handlers (src/cli/signals.hpp).
sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  return set;
}

// Runs in the child between fork and exec, where only async-signal-safe calls are allowed.
[[noreturn]] void exec_program(char* const* arguments, int messages, pid_t parent, const sigset_t& held) {
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(messages, STDERR_FILENO);
  setpgid(0, 0);
  sigprocmask(SIG_BLOCK, &held, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() == parent) // otherwise the parent died before prctl()
    execv(program, arguments);
  _exit(127);
}

std::string text_of(std::FILE* file) {
  std::string text;
  char buffer[4096];
  std::rewind(file);
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
    text.append(buffer, n);
  return text;
}

// Returns the last line that begins with the name of the program, without the name.
std::string last_message(const std::string& text) {
  const std::string mark = "keeler: ";
  const std::size_t last = text.rfind("\n" + mark);
  const std::size_t begin = last != std::string::npos ? last + 1 : text.starts_with(mark) ? 0 : std::string::npos;
  if (begin == std::string::npos)
    return {};
  const std::size_t from = begin + mark.size();
  return text.substr(from, text.find('\n', from) - from);
}

} // namespace

Child::Child(const std::vector<std::string>& arguments) : messages_(std::tmpfile()) {
  if (!messages_)
    throw IoError(fmt::format("cannot make a temporary file for the messages of a run: {}", std::strerror(errno)));
  fcntl(fileno(messages_.get()), F_SETFD, FD_CLOEXEC);
  assert(!arguments.empty());
  std::vector<std::string> words = {"keeler"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  const sigset_t held = stop_signals();
  process_ = fork();
  if (process_ == 0)
    exec_program(pointers.data(), fileno(messages_.get()), parent, held);
  if (process_ < 0)
    throw Error(ExitCode::run_time, fmt::format("cannot start a process for a run: {}; lower --jobs, or end other "
                                                "programs",
                                                std::strerror(errno)));
}

Child::~Child() {
  stop();
}

std::optional<ChildEnd> Child::end() {
  int status = 0;
  if (process_ < 0 || waitpid(process_, &status, WNOHANG) != process_)
    return std::nullopt;
  process_ = -1;
  return ended_with(status);
}

ChildEnd Child::ended_with(int status) const {
  if (WIFSIGNALED(status))
    return {128 + WTERMSIG(status),
            fmt::format("the run was ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))};
  return {WEXITSTATUS(status), last_message(text_of(messages_.get()))};
}

void Child::stop() {
  if (process_ > 0)
    kill(process_, SIGTERM);
}

} // namespace keeler::batch
