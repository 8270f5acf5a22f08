// The particle store: one 64-byte line a particle with all that a drift needs, and an id.
// Memory order is for speed alone; whatever depends on an order uses the ids, which are unique and never change.
#pragma once

#include <keeler/core/field_table.hpp>
#include <keeler/hill/elements.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace keeler {

/// Elements (m) at the common epoch, radius (m) and mass (kg). Aligned: in memory, one line of cache.
struct alignas(64) Body {
  Elements elements;
  double radius = 0.0;
  double mass = 0.0;
};
static_assert(sizeof(Body) == 64);

/// What a velocity change dv at the rotation's time adds to m c_y², c_y the velocity along y beyond the shear.
inline double azimuthal_gain(const Body& body, const Vec3& dv, const Frequencies& f, const Rotation& r) {
  return body.mass * dv.y() * (2.0 * azimuthal_velocity(body.elements, f, r) + dv.y());
}

/// A turn about z, by which vectors that stand still among the stars turn in Hill's frame.
struct SpinTurn {
  double cosine = 1.0, sine = 0.0;

  SpinTurn() = default;
  explicit SpinTurn(double time) { sine_cosine(time, sine, cosine); }

  /// From the epoch to `time` after it, and back.
  Vec3 from_epoch(const Vec3& v) const { return {cosine * v.x() + sine * v.y(), cosine * v.y() - sine * v.x(), v.z()}; }
  Vec3 to_epoch(const Vec3& v) const { return {cosine * v.x() - sine * v.y(), cosine * v.y() + sine * v.x(), v.z()}; }
};

struct Particles {
  std::vector<Body> bodies;
  std::vector<std::uint64_t> ids;
  bool rough = false;      ///< whether they have spins
  std::vector<Vec3> spins; ///< of rough ones: angular velocity against the stars, in Hill's frame at the epoch, rad⁻¹

  std::size_t size() const { return bodies.size(); }

  /// For loops over all that do some work for each, k < size(): what comes a little later is on its way. Processors
  /// that run many instructions of each round see too few rounds ahead, and not all fetch ahead by themselves.
  void prefetch_after(std::size_t k) const { __builtin_prefetch(&bodies[std::min(k + 16, bodies.size() - 1)]); }

  /// Everything that must be stored to continue exactly.
  void list_fields(FieldTable& table) {
    table.particle_rows<double>("bodies", bodies, "m, kg",
                                "X, Y, e cos, e sin, i sin, i cos at the epoch; radius; mass");
    table.particle_rows<std::uint64_t>("ids", ids, "1", "unique identity, kept for ever");
    if (rough)
      table.particle_rows<double>("spins", spins, "rad^-1",
                                  "angular velocity against the stars, in Hill's frame at the epoch");
  }
};

} // namespace keeler
