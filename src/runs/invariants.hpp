// What holds at every boundary between two steps, looked at from outside: in the state as it stands, beside what it was
// a step before. Each check says what does not hold, "particles 3 and 17 overlap …", and nothing where all is well.
#pragma once

#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// What the sums of the budget are held against: all that was booked, and the epicycles themselves, kg m² rad⁻².
double energy_scale(const SimulationState& state, const ParticleMeans& means, const Frequencies& frequencies);

/// A residual of the energy budget that no rounding makes, over energy_scale(): of a whole run, and of one step.
inline constexpr double allowed_residual = 1e-9, allowed_residual_of_step = 1e-11;

/// The energy of the epicycles and the books, of which one not finite number makes all not finite; and the residual of
/// the whole run. It costs nothing beside the means.
std::string fault_of_books(const SimulationState& state, const ParticleMeans& means, const Frequencies& frequencies);

/// Elements, spins, accelerations: all are finite.
std::string fault_of_numbers(const SimulationState& state);

/// No two particles overlap by more than rounding (allowed_overlap).
std::string fault_of_overlap(const Patch& patch);

/// What a step has missed of the neighbours.
std::string fault_of_neighbours(const NeighbourAudit& audit);

/// A state before a step, and from kick to kick of each force the ticks (Simulation::ticks_between_kicks).
struct BeforeStep {
  SimulationState state;
  std::vector<std::int64_t> kick_ticks;
  double residual = 0.0; ///< of the budget, kg m² rad⁻²
};
BeforeStep before_step(const Simulation& simulation);

/// The same particles as before: ids, radii, masses.
std::string fault_of_particles(const SimulationState& before, const SimulationState& now);

/// What the step has added to the residual of the budget.
std::string fault_of_energy(const BeforeStep& before, const SimulationState& now, const ParticleMeans& means,
                            const Frequencies& frequencies);

/// Collisions keep Σ mX, Σ mY, Σ m e and Σ m i, the vectors at one epoch: what the step has done to these beyond kicks,
/// the way along the orbits and wraps is nothing in sum. X and Y are left out where collisions carried a particle
/// farther than a quarter of the box.
std::string fault_of_sums(const BeforeStep& before, const SimulationState& now, const Frequencies& frequencies);

/// The forces of self-gravity's last kick at this boundary, of some particles that the step draws, against the sum over
/// all pairs and images: their rms error is no more than forces_factor times what the solver is good for.
std::string fault_of_forces(const Scene& scene, const Boundary& boundary, const SimulationState& state);
inline constexpr double forces_factor = 4.0;

/// The rms error over the rms force that a solver's settings ask for; 0 where there is none: of the mesh alone and of
/// radial waves, which are not to be the sum over pairs.
double force_tolerance(const GravitySettings& settings);

} // namespace keeler
