// Overlapping spheres moved apart: descent of the overlap energy (O'Hern, Silbert, Liu & Nagel 2003) with momentum
// (Polyak 1964), over neighbour lists (Verlet 1967) that hold partners of every size.
//
// Each overlapping pair is pushed apart along its centre line, the lighter sphere by more. A tether pulls each sphere
// back to the height that was drawn for it, and fades: the spheres make room sideways before the layer thickens.
#pragma once

#include "sphere.hpp"
#include "sphere_slabs.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <functional>
#include <vector>

namespace keeler {

/// In strips along y, a few spheres wide: neighbours in space become neighbours in memory.
void sort_by_place(std::vector<Sphere>& spheres, const ShearingBox& box);

/// Moves the spheres until each pair is farther apart than contact by at least 2 × 10⁻⁵ of the smaller radius, in about
/// a hundred sweeps over all of them. Those that are held stay, and may touch each other. Spheres should be sorted by
/// place. Calls after_sweep(number of sweeps so far). False when overlaps are left after so many sweeps. Throws
/// Interrupted. The bits depend neither on the number of threads nor on which spheres each rank has. Collective.
bool separate(std::vector<Sphere>& spheres, const ShearingBox& box, double offset, SphereSlabs& slabs, int max_sweeps,
              const std::function<void(int)>& after_sweep);

/// The same inside a ball about the origin, in which all of each sphere comes to lie; heights do not matter.
bool separate_in_ball(std::vector<Sphere>& spheres, double ball_radius, int max_sweeps);

} // namespace keeler
