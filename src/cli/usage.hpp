// Commands and options as people name them, and what the program says of a command line that it cannot take.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace keeler {

/// "keeler bench drift".
std::string full_name(const CLI::App& command);

/// The command that a parsed command line names, as far as it was understood.
const CLI::App& asked_command(const CLI::App& program);

/// The commands below this one, without those that --help does not list.
std::vector<const CLI::App*> listed_commands(const CLI::App& command);

/// What stands for the value of an option, or for an argument, in --help: "FILE", "dark|light"; empty for a flag.
std::string placeholder_of(const CLI::Option& option);

/// The line on what was wrong: a command or an option that does not exist, with the nearest one that does, or what
/// CLI11 found.
std::string usage_fault(const CLI::App& program, const CLI::ParseError& error);

} // namespace keeler
