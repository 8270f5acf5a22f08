// The particle store: per particle one 64-byte record with all that a drift needs, and an id. The order in memory
// affects only speed; results that depend on an order use the ids, which are unique and never change.
#pragma once

#include <keeler/hill/elements.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace keeler {
class FieldTable;
} // namespace keeler

namespace keeler::particles {

/// Elements (m) at the common epoch, radius (m) and mass (kg), aligned to one cache line.
struct alignas(64) Body {
  Elements elements;   ///< at the common epoch, m
  double radius = 0.0; ///< m
  double mass = 0.0;   ///< kg
};
static_assert(sizeof(Body) == 64);

/// Returns the change of m c_y² by a velocity change dv at the time of the rotation; c_y is the azimuthal_velocity().
inline double azimuthal_gain(const Body& body, const Vec3& dv, const Frequencies& f, const Rotation& r) {
  return body.mass * dv.y() * (2.0 * azimuthal_velocity(body.elements, f, r) + dv.y());
}

/// The rotation about z, in Hill's frame, of vectors that are constant in the inertial frame.
struct SpinTurn {
  double cosine = 1.0; ///< of the time
  double sine = 0.0;   ///< of the time

  SpinTurn() = default;
  explicit SpinTurn(double time) { hill::sine_cosine(time, sine, cosine); } ///< since the epoch, rad

  /// Transforms components at the epoch to components at `time` after it.
  Vec3 from_epoch(const Vec3& v) const { return {cosine * v.x() + sine * v.y(), cosine * v.y() - sine * v.x(), v.z()}; }
  /// Inverse of from_epoch().
  Vec3 to_epoch(const Vec3& v) const { return {cosine * v.x() - sine * v.y(), cosine * v.y() + sine * v.x(), v.z()}; }
};

/// All particles of a state, or those of one rank: arrays with one entry per particle, in their order in memory.
struct Particles {
  std::vector<Body> bodies;       ///< elements, radii and masses
  std::vector<std::uint64_t> ids; ///< unique; they never change
  bool rough = false;             ///< they have spins
  std::vector<Vec3> spins; ///< if rough: inertial angular velocity, components in Hill's frame at the epoch, rad⁻¹

  std::size_t size() const { return bodies.size(); } ///< number of particles

  /// Prefetches the body a few iterations after k, in loops over all particles: hardware does not always prefetch far
  /// enough ahead when each iteration has many instructions. Precondition: k < size().
  void prefetch_after(std::size_t k) const { __builtin_prefetch(&bodies[std::min(k + 16, bodies.size() - 1)]); }

  /// Adds everything that an exact restart needs.
  void list_fields(FieldTable& table);
};

} // namespace keeler::particles

namespace keeler {
using particles::Body, particles::Particles;
} // namespace keeler
