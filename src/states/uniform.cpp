#include <keeler/states/uniform.hpp>

#include <keeler/cells/grid.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double enough = 1e-5; // the least clearance of a finished state, in radius sums
constexpr int most_sweeps = 5000;

// How pairs are pushed apart: to this much more than contact (in radius sums), by this share of what is missing; and
// whether particles that have room themselves give way to neighbours that have none.
struct Effort {
  double clearance, strength;
  bool give_way;
};

// Sparse layers are done in a few strong sweeps that move only what overlaps. In a crowd that comes to a standstill,
// particles squeezed between others that stay where they are: then all give way, gently, so as not to swing.
Effort effort_of(int sweep) {
  constexpr int patience = 500;
  return sweep < patience ? Effort{1e-4, 1.02, false} : Effort{1e-3, 0.5, true};
}

// Epicycles of random phase about each place: the in-plane motion is a velocity alone, the vertical one is also a
// height.
void draw(const UniformRequest& request, std::size_t k, Vec3& place, Vec3& motion) {
  RandomStream where(request.seed, RandomPurpose::position, k), how(request.seed, RandomPurpose::velocity, k);
  const Frequencies& f = request.frequencies;
  place.x() = (where.uniform() - 0.5) * request.box.size_x;
  place.y() = (where.uniform() - 0.5) * request.box.size_y;
  place.z() = request.dispersion_z / f.nu * where.normal();
  const Elements streamline = request.streamlines.elements(place.x());
  place.x() -= streamline.e_cos;
  place.y() += 2.0 / f.kappa * streamline.e_sin;
  motion.x() = request.dispersion_x * how.normal();
  motion.y() = 0.5 * f.kappa * request.dispersion_x * how.normal();
  motion.z() = request.dispersion_z * how.normal();
}

// Half of what separates particle i from clearing each neighbour, added up; the deepest shortfall in radius sums.
struct Push {
  Vec3 shift = Vec3::Zero();
  double deepest = 0.0;
};

Push push_of(const PeriodicGrid& grid, const Patch& patch, std::size_t i, double r_max, const Effort& effort) {
  Push push;
  const double reach = (patch.radii[i] + r_max) * (1.0 + effort.clearance);
  grid.visit_near(patch.positions[i], reach, reach, [&](std::size_t j, const Image& image) {
    const Vec3 d = patch.positions[i] - patch.positions[j] - patch.box.displacement(image, patch.offset);
    const double sum = patch.radii[i] + patch.radii[j], wanted = sum * (1.0 + effort.clearance);
    const double distance = d.norm();
    if (j == i || distance >= wanted)
      return;
    // the smaller one moves more: shares go with the other's cross-section
    const double share =
        patch.radii[j] * patch.radii[j] / (patch.radii[i] * patch.radii[i] + patch.radii[j] * patch.radii[j]);
    const Vec3 direction = distance > 0.0 ? Vec3(d / distance) : Vec3(0.0, 0.0, i < j ? -1.0 : 1.0);
    push.shift += direction * (share * (wanted - distance) * effort.strength);
    push.deepest = std::max(push.deepest, (sum * (1.0 + enough) - distance) / sum);
  });
  return push;
}

// Moves everything apart once; returns the deepest shortfall before the move.
double sweep(Patch& patch, double r_max, const Effort& effort) {
  PeriodicGrid grid;
  grid.build(patch.positions, patch.box, patch.offset, 2.0 * r_max * (1.0 + effort.clearance));
  std::vector<Push> pushes(patch.size());
  parallel_for(patch.size(), [&](std::size_t i) { pushes[i] = push_of(grid, patch, i, r_max, effort); });
  double deepest = 0.0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    deepest = std::max(deepest, pushes[i].deepest);
    if (effort.give_way || pushes[i].deepest > 0.0)
      patch.positions[i] += pushes[i].shift;
  }
  return deepest;
}

void separate(Patch& patch) {
  if (patch.size() == 0)
    return;
  const double r_max = *std::max_element(patch.radii.begin(), patch.radii.end());
  double deepest = 0.0;
  for (int k = 0; k < most_sweeps; ++k) {
    deepest = sweep(patch, r_max, effort_of(k));
    if (deepest <= 0.0)
      return;
  }
  throw UsageError(fmt::format("too dense: after {} attempts particles still overlap by {:.1e} of their radii; raise "
                               "particles.velocity_dispersion or lower the optical depth",
                               most_sweeps, deepest));
}

} // namespace

Patch uniform_patch(const UniformRequest& request) {
  const std::size_t count = request.radii.size();
  Patch patch;
  patch.box = request.box;
  patch.offset = request.box.first_offset;
  patch.frequencies = request.frequencies;
  patch.radii = request.radii;
  patch.positions.resize(count);
  patch.velocities.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    draw(request, k, patch.positions[k], patch.velocities[k]);
    patch.masses.push_back(4.0 / 3.0 * pi * request.density * std::pow(request.radii[k], 3));
    patch.ids.push_back(k);
  }
  separate(patch);
  for (std::size_t k = 0; k < count; ++k) { // the mean motion of the final place
    const double guiding_x = request.streamlines.guiding_x(patch.positions[k].x());
    patch.velocities[k] += state_at(request.streamlines.elements(guiding_x), request.frequencies, Rotation()).velocity;
  }
  return patch;
}

} // namespace keeler
