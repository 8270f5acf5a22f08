// How much a command says on standard error beside errors: -q and -v.
#pragma once

#include <keeler/scene/scene.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace keeler {

struct TalkOption {
  bool quiet = false, verbose = false;

  void add_to(CLI::App& command);

  /// For notes: says them, or nothing when quiet.
  std::function<void(const std::string&)> notice() const;

  /// When verbose: which program works, with what; and how a scene is computed.
  void say_program() const;
  void say_scene(const Scene& scene) const;
};

} // namespace keeler
