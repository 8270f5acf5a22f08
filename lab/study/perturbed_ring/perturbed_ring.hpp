// The paper's Figure 1 as an experiment: the drift of a ring with streamlines that bunch once per orbit, so that
// collisions prefer one side of the epicycle, when the paths within a step are approximated by straight lines.
//
// Equal spheres without self-gravity, κ = ν = Ω. The eccentricity vectors have the pattern e (cos, sin)(Ωt + kX) with
// q = k e; in addition all particles oscillate vertically in phase. Collisions conserve the mean guiding centre and the
// mean inclination vector exactly, so any change of these is an error. Undriven, the pattern decays within some orbits:
// before each step a radial impulse on every particle, with the pattern's phase, restores its amplitude q, as the force
// of a satellite would. The impulse changes neither X nor positions nor the vertical motion.
#pragma once

#include <keeler/collision/drift.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler::study {

/// Lengths in particle radii.
struct PerturbedRing {
  std::size_t count = 1000;
  double optical_depth = 0.3;
  int waves = 1;            ///< of the pattern in the box, which is square
  double bunching = 0.6;    ///< q
  double inclination = 2.0; ///< common to all particles
  double restitution = 0.5;
  double dispersion = 2.0;   ///< initial c_x, r Ω
  double step_orbits = 1e-3; ///< > 0
  double orbits = 100.0;
  int samples = 100; ///< rows, evenly spaced in time
  std::uint64_t seed = 1;
};

/// Name of the path of straight lines within a step.
inline constexpr const char* straight_path = "straight";

/// Name of the control: straight lines in a ring without bunching and without inclination.
inline constexpr const char* control_path = "straight-unperturbed";

/// One row of the figure's data. `mean_guiding_x_r` and `mean_vertical_r` are the drifts, since the start, of the means
/// over all particles of the unwrapped X and of the inclination vector along its initial direction.
struct DriftRow {
  double orbits = 0.0;
  std::string path; ///< "straight", "straight-unperturbed", or the name of a finder
  double step_orbits = 0.0;
  double mean_guiding_x_r = 0.0;
  double mean_vertical_r = 0.0;
  double collisions_per_particle = 0.0;
};

/// Runs the ring on one of the two straight paths or with the named finder, and returns the drift of the means. An
/// observer may watch the drift phase of a finder. Throws UsageError for an unknown name.
std::vector<DriftRow> perturbed_ring_drift(const PerturbedRing& ring, const std::string& path,
                                           collision::DriftObserver* observer = nullptr);

/// Returns the rows as CSV with a header.
std::string drift_csv(const std::vector<DriftRow>& rows);

} // namespace keeler::study
