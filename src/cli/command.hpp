// A subcommand: one file, which registers its options and leaves the action to main.
#pragma once

#include <keeler/core/error.hpp>

#include <CLI/CLI.hpp>

#include <functional>

namespace keeler {

/// What the chosen subcommand does; the program ends with the code it returns.
using Action = std::function<ExitCode()>;

/// Each adds its subcommand to the program; when the command line names it, it sets the action.
void add_check(CLI::App& program, Action& action);

} // namespace keeler
