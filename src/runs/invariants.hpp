// Invariants of the state at every boundary between two steps, checked against the state one step before where needed.
// Each check returns the description of the first fault, "particles 3 and 17 overlap …", or an empty string.
#pragma once

#include <keeler/cells/overlap.hpp>
#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler::runs {

/// Returns the scale of the energy budget: the sum of the magnitudes of all its terms and of the epicyclic energy,
/// kg m² rad⁻².
double energy_scale(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means,
                    const Frequencies& frequencies);

/// Largest residual of the energy budget, over energy_scale(), that rounding can explain: of a run, and of one step.
inline constexpr double allowed_residual = 1e-9, allowed_residual_of_step = 1e-11;

/// Checks that the energy budget of the run is finite and closes. A single number that is not finite makes its sums so
/// too. The cost is negligible beside the means.
std::string fault_of_budget(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means,
                            const Frequencies& frequencies);

/// Checks that all elements, spins and accelerations are finite.
std::string fault_of_numbers(const simulation::SimulationState& state);

/// Checks that the deepest overlap is no more than rounding (allowed_overlap).
std::string fault_of_overlap(const cells::Overlap& deepest);

/// Reports a pair that the neighbour lists of a step missed.
std::string fault_of_neighbours(const collision::NeighbourAudit& audit);

/// The state before a step, and the kick interval of each force in ticks (Simulation::ticks_between_kicks).
struct BeforeStep {
  simulation::SimulationState state;
  std::vector<std::int64_t> kick_ticks;
  double residual = 0.0; ///< of the energy budget, kg m² rad⁻²
};
BeforeStep before_step(const Simulation& simulation);

/// Checks that ids, radii and masses did not change.
std::string fault_of_particles(const simulation::SimulationState& before, const simulation::SimulationState& now);

/// Returns the state with the particles whose ids have the remainder rank() by the number of ranks, so that a rank can
/// compare particles of two states with different owners. Collective.
simulation::SimulationState dealt_by_id(const simulation::SimulationState& state, const Communicator& ranks);

/// Checks the change of the budget's residual in one step.
std::string fault_of_energy(const BeforeStep& before, const simulation::SimulationState& now,
                            const diagnostics::ParticleMeans& means, const Frequencies& frequencies);

/// Checks that collisions conserve Σ mX, Σ mY, Σ m e and Σ m i (e, i as vectors, at one epoch): the changes beyond
/// kicks, orbital drift and wraps must sum to zero. X and Y are not checked if collisions displaced a particle by more
/// than a quarter of the box. Collective: a rank may have a part of the particles, equal in both states. Precondition:
/// fault_of_particles() is empty.
std::string fault_of_sums(const BeforeStep& before, const simulation::SimulationState& now,
                          const Frequencies& frequencies, const Communicator& ranks = {});

/// Compares the self-gravity of the last kick on a random sample of particles with the sum over all pairs and images:
/// the rms error may be at most forces_factor times the solver's tolerance, or a larger sample decides. Collective.
/// Precondition: the step ended with a kick.
std::string fault_of_forces(const Scene& scene, const forces::Boundary& boundary,
                            const simulation::SimulationState& state);
inline constexpr double forces_factor = 4.0;

} // namespace keeler::runs
