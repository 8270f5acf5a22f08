// The program: reads the command line, runs one subcommand, and turns every error into one line and an exit code.
#include "command.hpp"
#include "messages.hpp"
#include "signals.hpp"
#include "usage.hpp"
#include "waiting_threads.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/comm/same_request.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

namespace keeler::cli {
namespace {

int fail(ExitCode code, const std::string& message) {
  if (!comm::another_rank_reports())
    say(message);
  comm::fail_ranks(code);
  return static_cast<int>(code);
}

// Reports the current exception. Precondition: called within a catch clause.
int fail_at_hand() {
  const Error error = error_at_hand();
  return fail(error.code(), error.what());
}

// Returns the exit code after flushing standard output. Throws IoError when the results could not be written.
int end_with(ExitCode code) {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw IoError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  comm::finish_ranks();
  return static_cast<int>(code);
}

// Puts the commands added since the last call under a heading of --help.
void group(CLI::App& program, const std::string& heading) {
  const std::string none = CLI::App().get_group();
  for (CLI::App* command : program.get_subcommands({}))
    if (command->get_group() == none)
      command->group(heading);
}

// Adds the commands in the order of a user's work.
void add_commands(CLI::App& program, Action& action, const std::vector<std::string>& arguments,
                  const Communicator& ranks) {
  add_new(program, action);
  add_check(program, action);
  add_tune(program, action);
  add_generate(program, action, arguments);
  add_tile(program, action, arguments);
  group(program, "Start");
  add_run(program, action, arguments, ranks);
  add_view(program, action, arguments);
  add_watch(program, action);
  add_resume(program, action, arguments, ranks);
  add_sweep(program, action);
  group(program, "Run");
  add_info(program, action);
  add_render(program, action);
  add_report(program, action);
  add_analyze(program, action);
  add_photometry(program, action);
  add_occultation(program, action);
  add_convert(program, action);
  group(program, "Look");
  add_study(program, action, arguments);
  add_bench(program, action, ranks);
  group(program, "Study");
  add_help(program, action);
  group(program, "Help");
  add_complete(program, action);
}

// Throws UsageError when an MPI launcher starts several copies of a command that is not distributed.
void refuse_ranks(const std::string& command, const Communicator& ranks) {
  const std::vector<std::string> distributed = {"keeler", "keeler run", "keeler resume", "keeler bench step"};
  if (ranks.distributed() && std::find(distributed.begin(), distributed.end(), command) == distributed.end())
    throw UsageError(fmt::format("'{}' is for one process, and an MPI launcher has started {}; start it without the "
                                 "launcher (only run, resume and bench step can be distributed)",
                                 command, ranks.size()));
}

// The parsed command line.
struct Parsed {
  std::string command; // "keeler bench step"
  Action help;         // prints --help or --version if requested
};

Parsed parse(CLI::App& program, int argc, char** argv, const Communicator& ranks) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) { // --help and --version
    if (program.get_subcommands().empty() && program.remaining_size() > 0)
      throw UsageError(usage_fault(program, CLI::ExtrasError("keeler", program.remaining())));
    return {full_name(asked_command(program)) + (asked.get_name() == "CallForVersion" ? " --version" : " --help"),
            [&program, asked] {
              program.exit(asked);
              return ExitCode::done;
            }};
  } catch (const CLI::ParseError& error) {
    throw UsageError(usage_fault(program, error));
  }
  const std::string command = full_name(asked_command(program));
  refuse_ranks(command, ranks);
  return {command, {}};
}

int run(int argc, char** argv) {
  const Communicator ranks = Communicator::launched();
  if (!ranks.distributed()) // ranks have a policy of their own
    keep_freed_memory();
  if (!ranks.is_root() && !std::freopen("/dev/null", "w", stdout)) // only rank 0 prints results
    throw IoError("cannot open /dev/null");
  CLI::App program("Keeler simulates a self-gravitating patch of a planetary ring.", "keeler");
  program.set_version_flag("--version", "keeler " + program_version());
  program.require_subcommand(0, 1);
  Action action;
  const std::vector<std::string> arguments(argv, argv + argc);
  add_commands(program, action, arguments, ranks);
  examples_of(program, {"keeler run a-ring-wakes -o wakes", "keeler report wakes", "keeler help run"});
  Parsed parsed;
  ranks.together([&] { parsed = parse(program, argc, argv, ranks); });
  require_same_request({{"the command", parsed.command}}, ranks);
  release_signals();
  if (parsed.help)
    return end_with(parsed.help());
  if (!action)
    return end_with(print_help(program));
  ranks.together([] { set_threads(threads()); }); // refuses an invalid OMP_NUM_THREADS
  return end_with(action());
}

// Initializes HDF5 without its exit handler: after a damaged file HDF5 cannot close itself and prints long messages at
// exit, and its open objects are in memory only. HDF5 crashes when it starts with too little memory, so an allocation
// is tested first.
void start_hdf5() {
  constexpr std::size_t enough = std::size_t{4} << 20;
  H5dont_atexit();
  ::operator delete(::operator new(enough));
  H5open();
}

// Opens /dev/null for reading in place of closed standard streams. Otherwise the next opened file would get that
// descriptor, and messages would be written into it.
void fill_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0)
      open("/dev/null", O_RDONLY);
}

int run_program(int argc, char** argv) {
  hold_signals();
  let_threads_sleep(argv);
  fill_closed_streams();
  for (const int signal : {SIGXFSZ, SIGPIPE}) // a file-size limit and a closed pipe are then errors of the write
    std::signal(signal, SIG_IGN);
  try {
    start_hdf5();
    return run(argc, argv);
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) // fmt::print throws it
      return fail(ExitCode::input_output, "cannot write to standard output: " + error.code().message());
    return fail_at_hand();
  } catch (...) {
    return fail_at_hand();
  }
}

} // namespace
} // namespace keeler::cli

int main(int argc, char** argv) {
  return keeler::cli::run_program(argc, argv);
}
