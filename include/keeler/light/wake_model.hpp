// The model of self-gravity wakes that observers fit to optical depths: opaque bars, infinitely long and parallel, with
// gaps between them of a small optical depth. Colwell et al. (2006, GRL 33, L07201) take bars of rectangular section,
// Hedman et al. (2007, AJ 133, 2624) of elliptical section.
#pragma once

#include <keeler/light/photometry.hpp>

#include <optional>
#include <span>

namespace keeler::light {

/// The section of a bar.
enum class BarSection { rectangle, ellipse };

/// Bars of height H and width W, S apart from edge to edge.
struct WakeModel {
  BarSection section = BarSection::rectangle; ///< of a bar
  double height = 0.0;                        ///< H/W
  double gap = 0.0;                           ///< S/W
  double gap_depth = 0.0;                     ///< τ_gap, the normal optical depth of a gap
  double azimuth = 0.0;                       ///< φ_w of the bars, from +x towards +y, in [0, π), rad

  /// Returns the transmission along a line of sight. Rectangle: (S − H |sin(φ − φ_w)| cot B)/(S + W) e^{−τ_gap/sin B};
  /// ellipse: (S + W − √(W² + H² sin²(φ − φ_w) cot² B))/(S + W) e^{−τ_gap/sin B}; 0 where that is below 0.
  double transmission(const Bearing& star) const;
};

/// A measured transmission.
struct StarTransmission {
  Bearing star;              ///< where it was seen
  double transmission = 0.0; ///< T
  double error = 0.0;        ///< standard error of T, above 0
};

/// A model, with standard errors from the fit's covariance, times √(χ²/freedom) where that is above 1: real wakes are
/// no bars.
struct FittedWakes {
  WakeModel model;         ///< of least squares
  WakeModel errors;        ///< standard errors of its numbers
  double chi_square = 0.0; ///< Σ (difference/error)²
  std::size_t freedom = 0; ///< numbers fitted less 4
};

/// Returns the model of least squares; nothing for fewer than 5 transmissions, or all at one azimuth or one elevation,
/// which leave it open.
std::optional<FittedWakes> fit_wakes(std::span<const StarTransmission> transmissions, BarSection section);

} // namespace keeler::light
