// Manual pages for man(1).
#pragma once

#include "command.hpp"

namespace keeler {

/// Prints the source of a page such as keeler-run(1), or keeler(1) for the program, from the texts of --help. The page
/// of a command includes its subcommands.
ExitCode print_man_page(const CLI::App& command);

} // namespace keeler
