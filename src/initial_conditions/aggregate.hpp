// A randomly packed ball of particles: a rubble pile in an initial state.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler::initial_conditions {

/// One entry per particle.
struct Material {
  std::span<const double> radii;     ///< m
  std::span<const double> densities; ///< kg m⁻³
};

/// Returns positions of spheres inside a ball about the origin; the gap of each pair is at least 2 × 10⁻⁵ of the
/// smaller radius. Returns nothing if the ball is too small for a random packing. Same bits for any number of threads.
/// Throws Interrupted.
std::vector<Vec3> pack_ball(std::span<const double> radii, double ball_radius, std::uint64_t seed, std::uint64_t first);

/// Returns the particles of the scene's aggregate `number`, from 1. Its centre of mass is on a circular orbit, about
/// which it rotates rigidly. Throws UsageError if the particles cannot be packed.
std::vector<HeldBody> aggregate_bodies(const scene::AggregateSettings& aggregate, std::size_t number,
                                       const Material& material, const Frequencies& frequencies, std::uint64_t seed);

} // namespace keeler::initial_conditions
