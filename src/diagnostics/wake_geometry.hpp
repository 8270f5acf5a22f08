// Sizes and directions of self-gravity wakes in several snapshots of a run, from the power spectrum (wake_spectrum.hpp)
// and from the central ridge of the autocorrelation (wakes.hpp). Values come from the summed spectra and from the mean
// autocorrelation; the scatter is that of single snapshots.
#pragma once

#include <keeler/diagnostics/wakes.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/measured.hpp>

namespace keeler {

struct WakeGeometry {
  Wakes mean;                   ///< of the mean autocorrelation
  double contrast = 0.0;        ///< rms of the smoothed Σ/⟨Σ⟩ − 1
  Measured wavelength;          ///< λ_⊥, m
  Measured radial_wavelength;   ///< λ_x, m
  Measured angle_degrees;       ///< of the spectrum
  Measured inner_pitch_degrees; ///< of the ridge
  Measured outer_pitch_degrees;
};

/// Precondition: at least one snapshot, all of one box.
WakeGeometry wake_geometry(std::span<const Patch> patches, double critical_wavelength);

} // namespace keeler
