#include <keeler/initial_conditions/broken.hpp>

#include <keeler/core/format.hpp>
#include <keeler/initial_conditions/possible.hpp>

#include <fmt/format.h>

namespace keeler::initial_conditions {

std::size_t keep_possible(Patch& patch) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    if (!particle_fault(patch, k).empty())
      continue;
    patch.positions[kept] = patch.positions[k];
    patch.velocities[kept] = patch.velocities[k];
    patch.radii[kept] = patch.radii[k];
    patch.masses[kept] = patch.masses[k];
    patch.ids[kept] = patch.ids[k];
    if (!patch.spins.empty())
      patch.spins[kept] = patch.spins[k];
    ++kept;
  }
  const std::size_t left_out = patch.size() - kept;
  patch.positions.resize(kept);
  patch.velocities.resize(kept);
  patch.radii.resize(kept);
  patch.masses.resize(kept);
  patch.ids.resize(kept);
  patch.spins.resize(patch.spins.empty() ? 0 : kept);
  return left_out;
}

BrokenState::BrokenState(const InvariantError& error, const Simulation& simulation)
    : InvariantError(error), step(simulation.state().step), patch(simulation.patch_at_break()) {}

std::string broken_message(const InvariantError& error, const SavedState& saved) {
  std::string state = "no particle of the state can be saved";
  if (!saved.failure.empty())
    state = fmt::format("the state could not be saved: {}", saved.failure);
  else if (saved.particles > 0)
    state = fmt::format("the state is in '{}'{}; inspect it with keeler info, render or analyze", saved.file.string(),
                        saved.left_out > 0 ? fmt::format(", without {} that no snapshot may have",
                                                         pluralize(saved.left_out, "particle"))
                                           : "");
  return fmt::format("{}; this was at step {}, orbit {}, and {}", error.what(), saved.step, format_number(saved.orbits),
                     state);
}

std::string save_broken(const BrokenState& broken, const std::filesystem::path& file, const io::SnapshotMeta& meta) {
  Patch patch = broken.patch;
  SavedState saved{broken.step, patch.time_orbits, file, 0, keep_possible(patch), {}};
  saved.particles = patch.size();
  try {
    if (saved.particles > 0)
      write_snapshot(file, patch, meta);
  } catch (const IoError& not_saved) {
    saved.failure = not_saved.what();
  }
  return broken_message(broken, saved);
}

} // namespace keeler::initial_conditions
