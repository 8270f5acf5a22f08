// Moves overlapping spheres apart: descent of the overlap energy (O'Hern, Silbert, Liu & Nagel 2003) with momentum
// (Polyak 1964), over neighbour lists (Verlet 1967) that hold partners of every size.
//
// Each overlapping pair is pushed apart along its line of centres, the lighter sphere by more. A tether pulls each
// sphere back to its drawn height and fades: the spheres make room sideways before the layer thickens.
#pragma once

#include "sphere.hpp"
#include "sphere_slabs.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <functional>
#include <vector>

namespace keeler::initial_conditions {

/// Sorts by strips along y, a few spheres wide, so that neighbours in space are neighbours in memory.
void sort_by_position(std::vector<Sphere>& spheres, const ShearingBox& box);

/// Moves the spheres until the gap of each pair is at least 2 × 10⁻⁵ of the smaller radius, in about a hundred sweeps
/// over all of them. Held spheres stay, and may touch each other. Spheres should be sorted by position. Calls
/// after_sweep(number of sweeps so far). Returns false if overlaps remain after max_sweeps. Throws Interrupted. The
/// result depends neither on the number of threads nor on which spheres each rank has. Collective.
bool separate(std::vector<Sphere>& spheres, const ShearingBox& box, double offset, SphereSlabs& slabs, int max_sweeps,
              const std::function<void(int)>& after_sweep);

/// As above, inside a ball about the origin, which contains each sphere completely at the end; heights are ignored.
bool separate_in_ball(std::vector<Sphere>& spheres, double ball_radius, int max_sweeps);

} // namespace keeler::initial_conditions
