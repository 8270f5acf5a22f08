// The options -q and -v: messages on standard error besides errors.
#pragma once

#include <keeler/scene/scene.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace keeler::cli {

struct TalkOption {
  bool quiet = false, verbose = false;

  void add_to(CLI::App& command);

  /// Returns a function that prints notes, or drops them when quiet.
  std::function<void(const std::string&)> notice() const;

  /// Prints version, compiler, threads and instruction set when verbose.
  void say_program() const;
  /// Prints the finder and the gravity solver of a scene when verbose.
  void say_scene(const Scene& scene) const;
};

} // namespace keeler::cli
