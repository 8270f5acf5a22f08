// All subcommands. Each is one file, which registers its options and sets the action that main carries out.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/error.hpp>

#include <functional>
#include <string>
#include <vector>

namespace CLI { // NOLINT(readability-identifier-naming): CLI11 calls it so
class App;
}

namespace keeler::cli {

/// The action of the chosen subcommand. The program ends with the code that it returns.
using Action = std::function<ExitCode()>;

/// Each function adds its subcommand, which sets `action` when the command line names it. `arguments` is the whole
/// command line, for the provenance of written files.
void add_check(CLI::App& program, Action& action);
void add_generate(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_run(CLI::App& program, Action& action, const std::vector<std::string>& arguments, const Communicator& ranks);
void add_resume(CLI::App& program, Action& action, const std::vector<std::string>& arguments,
                const Communicator& ranks);
void add_complete(CLI::App& program, Action& action);
void add_help(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_convert(CLI::App& program, Action& action);
void add_analyze(CLI::App& program, Action& action);
void add_occultation(CLI::App& program, Action& action);
void add_photometry(CLI::App& program, Action& action);
void add_new(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action, const Communicator& ranks);
void add_study(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_sweep(CLI::App& program, Action& action);
void add_tile(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_tune(CLI::App& program, Action& action);
void add_view(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_watch(CLI::App& program, Action& action);

/// Adds a subcommand that the demo's program has not. It says how to build the whole program.
void leave_out(CLI::App& program, Action& action, const char* name);

} // namespace keeler::cli
