// Self-gravity wakes in the autocorrelation: direction of the central ridge, distance to the next wake.
//
// Pitch: the angle from the y axis of the central ridge, a line fitted to its crest (the largest ξ at each Δy) out to
// one λ_cr; positive when trailing, that is if the outer part of a wake (x > 0) lags behind (y < 0). The crest starts
// in the direction along which the mean of ξ over a line through zero lag is largest. Spacing: ξ is averaged along that
// direction into a function of the radial lag Δx (at Δy = 0); the spacing is its first side maximum.
//
// The ridge bends, so its pitch is also given for two parts, after Michikoshi, Fujii, Kokubo & Salo (2015, ApJ 812,
// 151), who fit the inner and the outer part of the autocorrelation separately. The limits are Keeler's: the inner part
// ends λ_cr/2 from zero lag and its line passes through zero lag; the outer part extends from there to 3/2 λ_cr.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/diagnostics/autocorrelation.hpp>

#include <optional>
#include <vector>

namespace keeler::diagnostics {

/// Lines extend 3/4 λ_cr to each side (less in a small box). Finds no wakes if the map does not resolve λ_cr, or if the
/// amplitude is below 0.02 or below five times the noise of random particles.
Wakes find_wakes(const AutocorrelationMap& map, double critical_wavelength);

} // namespace keeler::diagnostics
