#include "talk.hpp"

#include "messages.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/simd.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/version.hpp>

#include <fmt/format.h>

namespace keeler::cli {

void TalkOption::add_to(CLI::App& command) {
  CLI::Option* const no_notes = command.add_flag("-q,--quiet", quiet, "print errors only, no progress and no notes");
  command.add_flag("-v,--verbose", verbose, "print version, threads, solvers, and the begin of each phase")
      ->excludes(no_notes);
}

std::function<void(const std::string&)> TalkOption::notice() const {
  if (quiet)
    return [](const std::string&) {};
  return say;
}

void TalkOption::say_program() const {
  if (verbose)
    say(fmt::format("version {}, commit {}, {}; {}, {}", program_version(), source_commit(), build_compiler(),
                    pluralize(static_cast<std::uint64_t>(threads()), "thread"),
                    instruction_set_name(choose_instruction_set())));
}

void TalkOption::say_scene(const Scene& scene) const {
  if (verbose)
    say(fmt::format("finder {}, {}", scene.collisions.finder,
                    scene.gravity ? "gravity " + advice::in_words(chosen_for(scene.particles.count, *scene.gravity))
                                  : "no gravity"));
}

} // namespace keeler::cli
