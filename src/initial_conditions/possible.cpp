#include <keeler/initial_conditions/possible.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {
namespace {

// A number of the frame, stored in /RingBox of a snapshot.
struct FrameNumber {
  const char* what;
  double value;
  const char* unit;
  KeyRange range;
};

void require_in_range(const FrameNumber& number, const std::string& path) {
  if (!number.range.contains(number.value))
    throw InvariantError(fmt::format("'{}' has {} of {}{} (possible is {}); correct it or take another state", path,
                                     number.what, format_number(number.value, 4), number.unit, number.range.words()));
}

void require_possible_orbits(const Patch& patch, const std::string& path) {
  constexpr double longest_run = 1e15; // orbits
  const Frequencies& frequencies = patch.frequencies;
  require_in_range({"an Omega", patch.orbital_frequency, " rad/s", scene::find_key("planet.orbital_frequency")->range},
                   path);
  require_in_range({"a kappa_over_Omega", frequencies.kappa, "", scene::find_key("planet.epicyclic_ratio")->range},
                   path);
  require_in_range({"a nu_over_Omega", frequencies.nu, "", scene::find_key("planet.vertical_ratio")->range}, path);
  require_in_range({"a time_orbits", patch.time_orbits, "", {.low = 0.0, .high = longest_run}}, path);
  if (!(std::fabs(patch.box.shear - frequencies.shear()) <= 1e-6 * frequencies.shear()))
    throw InvariantError(fmt::format("'{}' has a shear_over_Omega of {}, but its kappa_over_Omega gives {} "
                                     "(2 - kappa^2/2); correct one of them or take another state",
                                     path, format_number(patch.box.shear, 7), format_number(frequencies.shear(), 7)));
}

void require_possible_offsets(const Patch& patch, const std::string& path) {
  const KeyRange within_box = {.low = 0.0, .high = patch.box.size_y};
  require_in_range({"a shear_offset", patch.offset, " m, modulo L_y", within_box}, path);
  require_in_range({"a shear_offset_at_start", patch.box.first_offset, " m, modulo L_y", within_box}, path);
}

} // namespace

std::string particle_fault(const Patch& patch, std::size_t k) {
  assert(k < patch.size() && patch.velocities.size() == patch.size() && patch.masses.size() == patch.size());
  static const KeyRange radii = scene::find_key("particles.sizes.radius")->range,
                        densities = scene::find_key("particles.density")->range,
                        coordinates = {.high = scene::find_key("box.size")->range.high},
                        speeds = {.high = 1000.0}; // m/s relative to the shear flow: ring orbits have 10 to 20 km/s
  const Vec3 &position = patch.positions[k], &velocity = patch.velocities[k];
  if (!position.allFinite() || !velocity.allFinite())
    return "a position or a velocity that is not finite";
  const Vec3 spin = patch.spins.empty() ? Vec3(Vec3::Zero()) : patch.spins[k];
  if (!spin.allFinite())
    return "a spin that is not finite";
  struct Quantity {
    const KeyRange& range;
    const char* what;
    double value;
  };
  const double radius = patch.radii[k];
  const Vec3 shear(0.0, -patch.box.shear * position.x(), 0.0);
  const std::array<Quantity, 5> quantities = {
      {{radii, "a radius (m)", radius},
       {densities, "a density (kg/m^3, by its mass and radius)",
        patch.masses[k] / (4.0 / 3.0 * pi * radius * radius * radius)},
       {coordinates, "a coordinate (m)", position.cwiseAbs().maxCoeff()},
       {speeds, "a speed (m/s, beyond the shear)", (velocity - shear).norm() * patch.orbital_frequency},
       {speeds, "a speed of its equator (m/s, by its spin)", spin.norm() * radius * patch.orbital_frequency}}};
  for (const Quantity& q : quantities)
    if (!q.range.contains(q.value))
      return fmt::format("{} of {} (possible is {})", q.what, format_number(q.value, 3), q.range.words());
  if (const double narrow = std::min(patch.box.size_x, patch.box.size_y); 2.0 * radius > narrow)
    return fmt::format("a diameter of {} m, larger than the width of the box ({} m)", format_number(2.0 * radius, 4),
                       format_number(narrow, 4));
  return {};
}

// In snapshots the guiding centres are in the cell in the middle of a step, so some are slightly outside. A tenth of
// the box exceeds the shear during the longest half step of an automatic run.
std::string box_fault(const State& state, const ShearingBox& box, const Frequencies& frequencies) {
  constexpr double reach = 0.6; // of the sides
  const auto within = [&](double x, double y) {
    return std::fabs(x) <= reach * box.size_x && std::fabs(y) <= reach * box.size_y;
  };
  const Elements el = elements_from(state, frequencies, Rotation());
  if (within(state.position.x(), state.position.y()) || within(el.guiding_x, el.guiding_y))
    return {};
  return fmt::format("x = {}, y = {} outside the box of {} m x {} m about 0 (as has its guiding centre)",
                     format_number(state.position.x()), format_number(state.position.y()), format_number(box.size_x),
                     format_number(box.size_y));
}

void require_possible(const Patch& patch, const std::string& path) {
  require_possible_frame(patch, patch.size(), path);
  require_possible_particles(patch, path);
}

void require_possible_frame(const Patch& patch, std::size_t count, const std::string& path) {
  if (count == 0)
    throw UsageError(fmt::format("'{}' holds no particles; choose another state", path));
  require_possible_orbits(patch, path);
  const KeyRange& sizes = scene::find_key("box.size")->range;
  if (!sizes.contains(patch.box.size_x) || !sizes.contains(patch.box.size_y))
    throw InvariantError(fmt::format("the box of '{}' is {} m x {} m (a patch has sizes {}); take another state", path,
                                     format_number(patch.box.size_x, 4), format_number(patch.box.size_y, 4),
                                     sizes.words()));
  const double longer = std::max(patch.box.size_x, patch.box.size_y),
               shorter = std::min(patch.box.size_x, patch.box.size_y);
  if (!(longer <= scene::max_aspect_ratio * shorter))
    throw InvariantError(fmt::format(
        "the box of '{}' is {} m x {} m, more than {:g} times as long as wide; take another "
        "state",
        path, format_number(patch.box.size_x, 4), format_number(patch.box.size_y, 4), scene::max_aspect_ratio));
  require_possible_offsets(patch, path);
}

void require_possible_particles(const Patch& patch, const std::string& path) {
  try {
    require_sound(patch);
  } catch (const InvariantError& error) {
    throw InvariantError(fmt::format("'{}': {}", path, error.what()));
  }
  for (std::size_t k = 0; k < patch.size(); ++k)
    if (const std::string fault = particle_fault(patch, k); !fault.empty())
      throw InvariantError(
          fmt::format("particle {} of '{}' has {}; correct it or take another state", patch.ids[k], path, fault));
  cells::require_no_heap(patch, "'" + path + "'");
}

} // namespace keeler::initial_conditions
