// A clumped state: the initial state of a scene, evolved under its own gravity until its wakes have settled.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/statistics/measured.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace keeler::initial_conditions {

/// Bounds on the means of a quantity in two successive windows, relative to the mean over both.
struct MeanBounds {
  double error = 0.0;  ///< largest standard error of either mean
  double change = 0.0; ///< a smaller difference is accepted, however small the errors are
};

/// When wakes count as settled: the means of two successive windows agree. docs/dev/starts.md has the runs from which
/// these numbers were chosen.
struct SettleCriterion {
  double samples_per_orbit = 20.0;                       ///< measurements of the patch
  double first_orbit = 5.0;                              ///< begin of the earliest window: after the overshoot
  std::size_t min_window_orbits = 2;                     ///< shortest window
  double max_orbits = 30.0;                              ///< give up after this
  MeanBounds viscosity{.error = 0.10, .change = 0.10};   ///< by the work of the shear
  MeanBounds wavelengths{.error = 0.05, .change = 0.05}; ///< λ_⊥ and λ_x
  double standard_errors = 2.0;                          ///< accepted difference, if that exceeds MeanBounds::change
  double min_standing = 0.5;       ///< fraction of a window's samples with wakes above the noise, each by itself
  double largest_deviation = 0.15; ///< relative, of the contrast of the last sample from that of the last window

  /// Returns the earliest time at which wakes can have settled.
  double min_orbits() const { return first_orbit + 2.0 * static_cast<double>(min_window_orbits); }
};

/// A quantity in two successive windows.
struct WindowMeans {
  Estimate before;        ///< in the first window
  Estimate last;          ///< in the second window
  double tolerance = 0.0; ///< of change()

  double mean() const { return 0.5 * (before.value + last.value); }               ///< of both windows
  double change() const { return std::fabs(last.value - before.value) / mean(); } ///< relative difference
  double error() const { return std::max(before.error, last.error) / mean(); }    ///< relative, the larger of the two
};

/// The last two windows of a history.
struct Settling {
  std::size_t window_orbits = 0; ///< length of a window
  WindowMeans viscosity;         ///< m² rad⁻¹
  WindowMeans wavelength;        ///< λ_⊥, m; NaN in a window without wakes
  WindowMeans radial_wavelength; ///< λ_x, m; NaN in a window without wakes
  double standing = 0.0;         ///< fraction of samples with wakes above the noise, the smaller of the two windows
  double contrast = 0.0;         ///< rms of the smoothed Σ/⟨Σ⟩ − 1 over the last window
  double deviation = 0.0;        ///< |contrast of the last sample − contrast| / contrast
};

/// The patch at one instant of the evolution.
struct ClumpingSample {
  double orbits = 0.0;                     ///< since the start
  double work = 0.0;                       ///< of the shear since the start, per mass and S², m²
  double contrast = 0.0;                   ///< rms of the smoothed Σ/⟨Σ⟩ − 1
  std::optional<double> wavelength;        ///< λ_⊥, m; empty if wakes have no direction
  std::optional<double> radial_wavelength; ///< λ_x, m
};

/// The record of how a clumped state was made.
struct Clumping {
  SettleCriterion criterion;           ///< as given
  double sample_every_orbits = 0.0;    ///< 1 / samples_per_orbit, rounded to whole kick intervals
  double orbits = 0.0;                 ///< number of orbits evolved
  Settling settling;                   ///< at the end
  std::vector<ClumpingSample> history; ///< all samples
  double orbital_frequency = 0.0;      ///< rad/s: converts m² rad⁻¹ to m²/s
};

/// A clumped patch, and how it was made.
struct ClumpedState {
  Patch patch;       ///< its time is the orbits evolved
  Clumping clumping; ///< the record of the evolution
};

/// Progress of the evolution, reported after each step.
struct ClumpingProgress {
  double orbits = 0.0;              ///< evolved
  double elapsed_s = 0.0;           ///< wall time
  double contrast = 0.0;            ///< of the last sample: rms of the smoothed Σ/⟨Σ⟩ − 1
  std::optional<Settling> settling; ///< empty before criterion.min_orbits()
  SettleCriterion criterion;        ///< as given
  bool settled = false;             ///< true in the last report
};

/// Evolves the scene's initial state, with the scene's step and gravity, until its wakes have settled; ignores the
/// scene's end time and schedules. The result depends on scene and criterion only, not on the number of threads. Throws
/// UsageError for a scene without gravity or too small for wakes, and for a limit of orbits that is too short to
/// settle; Error (run_time) if they have not settled by then; BrokenState (broken.hpp) if a step violates an invariant;
/// Interrupted (interrupt.hpp), and what initial_patch() and Simulation throw.
ClumpedState clumped_state(const Scene& scene, const SettleCriterion& criterion = {},
                           const std::function<void(const ClumpingProgress&)>& progress = {});

/// Returns the record as numbers by name, for SnapshotMeta::clumping.
std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping);

} // namespace keeler::initial_conditions
