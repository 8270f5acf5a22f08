// The page of a command for man(1).
#pragma once

#include "command.hpp"

namespace keeler {

/// Prints the source of keeler-run(1), or of keeler(1) for the program, from what its --help is made of. A command with
/// parts has them all on its page.
ExitCode print_man_page(const CLI::App& command);

} // namespace keeler
