// The paper's Figure 1 as an experiment: a ring whose streamlines bunch once an orbit, so that collisions prefer one
// side of the epicycle, and where it drifts to when the paths within a step are taken for straight lines.
//
// Equal spheres without self-gravity, κ = ν = Ω. The eccentricity vectors have the pattern e (cos, sin)(Ωt + kX) with
// q = k e; all particles swing up and down together besides. Collisions keep the mean guiding centre and the mean
// inclination vector exactly, so whatever these do is an error. A pattern left alone decays within some orbits: before
// each step a radial impulse on every particle, patterned alike, brings the mean pattern back to q, as a satellite's
// pull would. It changes no X and no place, and nothing vertical.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// Lengths in particle radii.
struct PerturbedRing {
  std::size_t count = 1000;
  double optical_depth = 0.3;
  int waves = 1;            ///< of the pattern in the box, which is a square
  double bunching = 0.6;    ///< q
  double inclination = 2.0; ///< common to all particles
  double restitution = 0.5;
  double dispersion = 2.0; ///< c_x at the start, r Ω
  double step_orbits = 1e-3;
  double orbits = 100.0;
  int samples = 100; ///< rows, evenly spaced in time
  std::uint64_t seed = 1;
};

/// The path that is no finder's: straight lines within a step.
inline constexpr const char* straight_path = "straight";

/// Straight lines in a ring without bunching and without inclination: the control.
inline constexpr const char* control_path = "straight-unperturbed";

/// One row of the figure's data. `mean_guiding_x_r` and `mean_vertical_r` are what the means over all particles have
/// drifted by since the start: X, unwrapped, and the inclination vector along its first direction.
struct DriftRow {
  double orbits = 0.0;
  std::string path; ///< "straight", "straight-unperturbed", or the name of a finder
  double step_orbits = 0.0;
  double mean_guiding_x_r = 0.0;
  double mean_vertical_r = 0.0;
  double collisions_per_particle = 0.0;
};

/// A path's drift, and what straight lines would have added to it at each collision (0 for the straight paths
/// themselves): the figure's prediction, made from exact collisions.
struct Drift {
  std::vector<DriftRow> rows;
  double forecast_guiding_x_r = 0.0;
  double forecast_vertical_r = 0.0;
};

/// Runs the ring on one of the two straight paths or with a finder of that name. Throws UsageError for an unknown name.
Drift perturbed_ring_drift(const PerturbedRing& ring, const std::string& path);

/// The rows as CSV, a header first.
std::string drift_csv(const std::vector<DriftRow>& rows);

} // namespace keeler
