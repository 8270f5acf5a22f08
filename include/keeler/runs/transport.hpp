// The transport of angular momentum and the balance of energy of a run, from its series: viscosities with errors, and
// whether collisions lose what the shear's stresses gain.
#pragma once

#include <keeler/io/series.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/time_series.hpp>

#include <optional>

namespace keeler {

/// Part of a run, in orbits.
struct OrbitWindow {
  std::optional<double> since; ///< none: from where on the run is steady
  std::optional<double> until; ///< none: the last row
};

/// What turns a series into viscosities.
struct RingScale {
  double mass = 0.0;              ///< kg, of all particles
  double orbital_frequency = 0.0; ///< rad/s
  double shear = 1.5;             ///< S, in units of it
  bool driven = false;            ///< other forces than self-gravity do work: the loss is then not the shear's alone

  static RingScale of(const Patch& patch, bool driven);
};

/// Axisymmetric epicyclic waves as long as the box (epicyclic_waves.hpp) in the two halves of a window: means of the
/// fraction of the epicyclic energy that they hold.
struct WaveGrowth {
  Estimate first_half, last_half;
  bool steady = false; ///< the means agree within three errors, or are both too small to matter

  double mean() const { return 0.5 * (first_half.value + last_half.value); }
};

/// Means over a window. Viscosities in m²/s.
struct Transport {
  double since_orbit = 0.0, until_orbit = 0.0;
  bool since_found = false; ///< the beginning was looked for, not given, in eight rows at least
  bool steady = false;      ///< loss and dispersion, without the waves, are (is_steady), over two orbits at least and a
                            ///< third of the run
  std::size_t intervals = 0;

  Estimate translational, collisional;
  std::optional<Estimate> gravitational; ///< none: not measured; without self-gravity 0
  std::optional<Estimate> total;         ///< none: without the gravitational one
  Estimate from_loss;                    ///< (loss + d(U + Φ)/dt) / (M S²): what the total must be
  std::optional<Estimate>
      balance; ///< from_loss over total: 1; none in a driven run, and where its error is larger than it
  std::optional<WaveGrowth> waves; ///< none: not in the series, or too few rows
};

/// Whether there is a viscosity to be had of all rows: at least three (of those with gravity's stress, where it is
/// measured), and the columns, which runs of former versions have not.
bool enough_rows(const SeriesTable& series);

/// Throws UsageError when the window holds fewer than three rows (of those with gravity's stress, where it is
/// measured).
Transport transport(const SeriesTable& series, const RingScale& scale, const OrbitWindow& window);

/// From which orbit on loss, dispersion and stress are steady, of the rows up to `until`: the latest of their
/// steady_start(). The first row's time for fewer than eight rows.
double steady_since(const SeriesTable& series, double until);

} // namespace keeler
