// What the files of subcommands share.
#pragma once

#include "commands.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace keeler::cli {

/// Appends examples to the --help of a command, each a whole command line: "keeler run scene.toml -o run". A test
/// parses all of them.
void examples_of(CLI::App& command, const std::vector<std::string>& lines);

/// Prints the text of --help.
ExitCode print_help(const CLI::App& command);

} // namespace keeler::cli
