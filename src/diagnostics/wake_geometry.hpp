// Sizes and directions of self-gravity wakes in several snapshots of a run, from the power spectrum (wake_spectrum.hpp)
// and from the central ridge of the autocorrelation (wakes.hpp). Values come from the summed spectra and from the mean
// autocorrelation; the scatter is that of single snapshots.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/diagnostics/wakes.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/measured.hpp>

namespace keeler::diagnostics {

/// Precondition: at least one snapshot, all of one box.
WakeGeometry wake_geometry(std::span<const Patch> patches, double critical_wavelength);

} // namespace keeler::diagnostics
