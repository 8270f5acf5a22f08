// Options that several commands share.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <CLI/CLI.hpp>

namespace keeler {

/// --threads N.
struct ThreadOption {
  int count = 0; ///< 0: as many as the machine offers

  void add_to(CLI::App& command) {
    command.add_option("--threads", count, "threads to use (default: all); the results are the same for any number")
        ->check(CLI::PositiveNumber);
  }

  void apply() const {
    if (count > 0)
      set_threads(count);
  }
};

} // namespace keeler
