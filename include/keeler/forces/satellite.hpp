// A satellite outside the box that passes the patch: its direct attraction, once or at every synodic period.
#pragma once

#include <keeler/forces/force.hpp>
#include <keeler/hill/elements.hpp>

#include <optional>

namespace keeler {

/// The scene's table [satellite].
ForceEntry satellite_entry();

/// A passage, and how far it is from what a cell can show: at the time t_n it sweeps over the streamlines at
/// |d|/|t_n − t_u|, and moves a particle there at up to 4/(3√3) G m/(κ² d²). Drag is the second speed over the first,
/// 4/(3√3) h |t_n − t_u|/κ² with h = G m/d³ (docs/theory/satellite.md): it must be well below 1. At 1 the passage goes
/// along with particles and throws them across the cell.
struct SatellitePassage {
  double orbits = 0.0; ///< t_n, of the middle of the box
  double drag = 0.0;
};

/// Above this drag a passage is not to be trusted; at 0.52 a ringlet is sound (docs/theory/satellite.md).
inline constexpr double doubtful_drag = 0.6;

/// Returns the first passage from `from` to `until` (orbits, both included) whose drag is at least `least`. The
/// parameters are those of the table [satellite].
std::optional<SatellitePassage> dragging_passage(const Parameters& parameters, double orbital_frequency,
                                                 const Frequencies& frequencies, double least, double from,
                                                 double until);

} // namespace keeler
