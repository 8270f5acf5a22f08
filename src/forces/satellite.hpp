// A satellite outside the box that passes the patch: its direct attraction, once or at every synodic period.
#pragma once

#include <keeler/forces/force.hpp>
#include <keeler/hill/elements.hpp>

#include <optional>

namespace keeler::forces {

/// Returns the entry of the scene's table [satellite].
ForceEntry satellite_entry();

/// A passage, and how well a cell can represent it. At the time t_n it sweeps over the streamlines at |d|/|t_n − t_u|,
/// and accelerates a particle there to up to 4/(3√3) G m/(κ² d²). Drag is the ratio of the second speed to the first,
/// 4/(3√3) h |t_n − t_u|/κ² with h = G m/d³ (docs/theory/satellite.md). It must be well below 1: at 1 the passage keeps
/// up with particles and throws them across the cell.
struct SatellitePassage {
  double orbits = 0.0; ///< t_n at the middle of the box
  double drag = 0.0;
};

/// Above this drag a passage is not reliable; at 0.52 a ringlet is sound (docs/theory/satellite.md).
inline constexpr double doubtful_drag = 0.6;

/// Returns the first passage from `from` to `until` (orbits, both included) with a drag of at least `min_drag`.
/// None if `until` is before `from`. `parameters` has the keys of the table [satellite]. Precondition: a distance other
/// than 0.
std::optional<SatellitePassage> dragging_passage(const Parameters& parameters, double orbital_frequency,
                                                 const Frequencies& frequencies, double min_drag, double from,
                                                 double until);

} // namespace keeler::forces
