#include "broken_state.hpp"

#include <keeler/initial_conditions/broken.hpp>
#include <keeler/initial_conditions/possible.hpp>

#include <fmt/format.h>

#include <optional>

namespace keeler::runs {
namespace {

// Writes the snapshot piece by piece. What it returns is complete on the root alone.
initial_conditions::SavedState save(const Simulation& simulation, const std::filesystem::path& path,
                                    const io::SnapshotMeta& meta) {
  initial_conditions::SavedState saved;
  saved.step = simulation.state().step;
  saved.file = path;
  std::optional<io::SnapshotFile> file;
  const auto try_to = [&](const auto& work) { // a full disk must not hide the error
    try {
      if (saved.failure.empty())
        work();
    } catch (const IoError& not_saved) {
      saved.failure = not_saved.what();
    }
  };
  saved.left_out = simulation.visit_at_break(
      io::SnapshotFile::piece,
      [](const Patch& patch, std::size_t k) { return initial_conditions::particle_fault(patch, k).empty(); },
      [&](const Patch& frame, std::size_t count) {
        saved.orbits = frame.time_orbits;
        saved.particles = count;
        if (count > 0)
          try_to([&] { file.emplace(path, frame, count, simulation.state().particles.rough, meta); });
      },
      [&](const Patch& piece) { try_to([&] { file->add(piece); }); });
  if (file)
    try_to([&] { file->finish(); });
  return saved;
}

} // namespace

void fail_broken(const InvariantError& error, const Simulation& simulation, const Scene& scene, const RunFolder& folder,
                 Recorder& recorder) {
  const initial_conditions::SavedState saved =
      save(simulation, folder.broken(simulation.state().step), {scene.resolved, recorder.provenance()});
  simulation.ranks().on_root([&] {
    std::string message = broken_message(error, saved);
    try {
      recorder.write_log("broken", {{"step", saved.step}, {"orbits", saved.orbits}, {"reason", error.what()}});
    } catch (const IoError& not_logged) {
      message += fmt::format("; the log was not written: {}", not_logged.what());
    }
    throw InvariantError(message);
  });
  throw error; // not reached: the root has thrown
}

} // namespace keeler::runs
