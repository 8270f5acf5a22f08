// A subcommand: one file, which registers its options and leaves the action to main.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/error.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler {

/// What the chosen subcommand does; the program ends with the code it returns.
using Action = std::function<ExitCode()>;

/// Ends the --help of a command with these lines, each a whole command: "keeler run scene.toml -o run". A test parses
/// them all.
void examples_of(CLI::App& command, const std::vector<std::string>& lines);

/// Prints what --help prints.
ExitCode print_help(const CLI::App& command);

/// Each adds its subcommand to the program; when the command line names it, it sets the action. `arguments` is the
/// whole command line, for the provenance of what is written.
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
void add_new(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action, const Communicator& ranks);
void add_study(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_sweep(CLI::App& program, Action& action);
void add_tile(CLI::App& program, Action& action, const std::vector<std::string>& arguments);
void add_tune(CLI::App& program, Action& action);
void add_watch(CLI::App& program, Action& action);

} // namespace keeler
