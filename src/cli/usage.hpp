// Names of commands and options, and the messages for invalid command lines.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace keeler::cli {

/// Returns the full name of a command: "keeler bench drift".
std::string full_name(const CLI::App& command);

/// Returns the command that a parsed command line names, as far as it was understood.
const CLI::App& asked_command(const CLI::App& program);

/// Returns the subcommands that --help lists.
std::vector<const CLI::App*> listed_commands(const CLI::App& command);

/// Returns the placeholder of an option's value, or of an argument, in --help: "FILE", "dark|light"; empty for a flag.
std::string placeholder_of(const CLI::Option& option);

/// Returns the error message: an unknown command or option with the nearest existing one, or the fault that CLI11
/// found.
std::string usage_fault(const CLI::App& program, const CLI::ParseError& error);

} // namespace keeler::cli
