// Angular momentum transport and energy balance of a run, from its series: viscosities with errors, and the ratio of
// the energy lost in collisions to the work of the shear on the stresses.
#pragma once

#include <keeler/io/series.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/time_series.hpp>

#include <optional>

namespace keeler::runs {

/// A part of a run, in orbits.
struct OrbitWindow {
  std::optional<double> since; ///< none: the orbit from which the run is steady
  std::optional<double> until; ///< none: the last row
};

/// The scales that turn a series into viscosities.
struct RingScale {
  double mass = 0.0;              ///< kg, of all particles
  double orbital_frequency = 0.0; ///< rad/s
  double shear = 1.5;             ///< S, in units of the orbital frequency
  bool driven = false;            ///< external forces do work: the loss does not come from the shear alone
  bool attracts = true;           ///< the scene has self-gravity

  static RingScale of(const Patch& patch, bool driven, bool attracts);
};

/// Axisymmetric epicyclic waves as long as the box (epicyclic_waves.hpp) in the two halves of a window: mean fractions
/// of the epicyclic energy.
struct WaveGrowth {
  Estimate first_half, last_half;
  bool steady = false; ///< the means agree within three errors, or are both too small to matter

  double mean() const { return 0.5 * (first_half.value + last_half.value); }
};

/// Means over a window. Viscosities in m²/s.
struct Transport {
  double since_orbit = 0.0, until_orbit = 0.0;
  bool since_found = false; ///< the beginning was detected, in at least eight rows, not given
  bool steady = false;      ///< loss and dispersion without the waves are steady (is_steady), over at least two orbits
                            ///< and a third of the run
  std::size_t intervals = 0;

  Estimate translational; ///< without the mean motion, where the series has it
  Estimate collisional;
  std::optional<Estimate> gravitational; ///< none: not measured; 0 without self-gravity
  std::optional<Estimate> total;         ///< none: the gravitational one was not measured
  Estimate from_loss;                    ///< (loss + d(U + Φ)/dt) / (M S²): must equal `total`
  std::optional<Estimate> balance; ///< from_loss / total, 1 in theory; none in a driven run or if its error exceeds it
  std::optional<WaveGrowth> waves; ///< none: not in the series, or too few rows
};

/// Returns true if all rows together give a viscosity: at least three rows (with the stress of gravity, if it is
/// measured), and columns that runs of earlier versions lack.
bool enough_rows(const io::SeriesTable& series);

/// Returns the means over a window. Throws UsageError when the window holds fewer than three rows (with the stress of
/// gravity, if it is measured).
Transport transport(const io::SeriesTable& series, const RingScale& scale, const OrbitWindow& window);

/// Returns the orbit from which loss, dispersion and stress are steady in the rows up to `until`: the latest of their
/// steady_start(); the time of the first row if there are fewer than eight.
double steady_since(const io::SeriesTable& series, double until);

} // namespace keeler::runs
