// A ball of particles, packed at random: a rubble pile, as a start has them.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// One entry a particle.
struct Material {
  std::span<const double> radii;     ///< m
  std::span<const double> densities; ///< kg m⁻³
};

/// Places of spheres inside a ball about the origin, each pair apart by at least 2 × 10⁻⁵ of the smaller radius; empty
/// where the ball is too small for them, packed at random. Same bits for any number of threads. Throws Interrupted.
std::vector<Vec3> pack_ball(std::span<const double> radii, double ball_radius, std::uint64_t seed, std::uint64_t first);

/// The particles of the scene's aggregate `number`, from 1: its centre of mass is on a circular orbit, about which it
/// turns as one body. Throws UsageError where they cannot be packed so.
std::vector<HeldBody> aggregate_bodies(const AggregateSettings& aggregate, std::size_t number, const Material& material,
                                       const Frequencies& frequencies, std::uint64_t seed);

} // namespace keeler
