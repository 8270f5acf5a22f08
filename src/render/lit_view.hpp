// What an observer sees of a patch in sunlight: each pixel is the I/F of rays through the spheres, with shadows and
// light of all orders of scattering (light/photometry.hpp).
#pragma once

#include "raster.hpp"

#include <keeler/render/lit_look.hpp>

#include <keeler/particles/patch.hpp>

namespace keeler::render {

/// Returns the I/F that is drawn white: a little more than a sphere shows that no other one shadows. It depends on the
/// law and the sight alone, so that pictures of a movie have one scale.
double white_level(const LitLook& look);

/// Draws the view, centred on the patch, periodic images filling the frame. The upward axis of the frame is the
/// vertical as the observer sees it. Throws Error without Embree, Interrupted.
Raster lit_view(const Patch& patch, const LitLook& look, int width, int height, double pixels_per_metre);

/// Returns the direction on the page (right, up) in which the observer sees a direction of the patch.
std::array<double, 2> seen_direction(const Vec3& direction, const light::Sight& sight);

} // namespace keeler::render
