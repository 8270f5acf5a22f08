#include "perturbed_ring.hpp"

#include "straight_drift.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/core/units.hpp>
#include <keeler/finders/finder.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <complex>
#include <optional>

namespace keeler::study {
namespace {

constexpr Frequencies unit_frequencies{1.0, 1.0};
constexpr double ring_frequency = 1.95e-4; // rad/s; without effect at a constant restitution

struct Ring {
  Particles particles;
  ShearingBox box;
  initial_conditions::EccentricityWave pattern;
};

Ring make_ring(const PerturbedRing& settings, double step) {
  assert(settings.count > 0 && settings.optical_depth > 0.0);
  const double side = std::sqrt(pi * static_cast<double>(settings.count) / settings.optical_depth);
  initial_conditions::UniformRequest request;
  request.box = {side, side, unit_frequencies.shear(), 0.0};
  request.frequencies = unit_frequencies;
  request.radii.assign(settings.count, 1.0);
  request.dispersion_x = settings.dispersion;
  request.dispersion_z = 0.65 * settings.dispersion; // as in equilibria without self-gravity
  request.streamlines = initial_conditions::Streamlines::bunched(settings.waves, side, settings.bunching);
  request.streamlines.inclination = settings.inclination;
  request.seed = settings.seed;
  return {particles_from(uniform_patch(request), 0.5 * step), request.box, request.streamlines.waves.front()};
}

// Returns the pattern's amplitude: the mean eccentricity vector, each turned back by its phase Ωt + kX at the epoch.
std::complex<double> pattern_amplitude(const Ring& ring, double epoch) {
  std::complex<double> sum = 0.0;
  for (const Body& body : ring.particles.bodies)
    sum += std::complex(body.elements.e_cos, body.elements.e_sin) *
           std::polar(1.0, -(epoch + ring.pattern.wave_number * body.elements.guiding_x));
  return sum / static_cast<double>(ring.particles.size());
}

// Restores the mean pattern by a radial impulse 2 Im(m exp i(Ωt + kX)) on each particle, where m is the missing
// amplitude: half of the impulse acts on the pattern, the other half counter-rotates and averages to zero over X.
void drive(Ring& ring, double epoch, double step) {
  const std::complex<double> missing = ring.pattern.eccentricity - pattern_amplitude(ring, epoch);
  const Rotation start(unit_frequencies, -0.5 * step);
  for (Body& body : ring.particles.bodies) {
    const double phase = epoch - 0.5 * step + ring.pattern.wave_number * body.elements.guiding_x;
    const double impulse = 2.0 * std::imag(missing * std::polar(1.0, phase));
    kick(body.elements, Vec3(impulse, 0.0, 0.0), unit_frequencies, start);
  }
}

// Moves the particles on straight or curved paths; exactly one of `straight_` and `curved_` is set.
class Mover {
public:
  Mover(const PerturbedRing& ring, const std::string& path, double step, collision::DriftObserver* observer) {
    collision::CollisionSettings settings;
    settings.restitution = collision::constant_restitution(ring.restitution);
    if (path == straight_path || path == control_path) {
      straight_.emplace(settings, unit_frequencies, ring_frequency, step);
      return;
    }
    settings.finder = path;
    curved_.emplace(settings, unit_frequencies, ring_frequency, step);
    curved_->observe(observer);
  }

  void collide(Ring& ring, double offset) {
    if (straight_) {
      collisions_ += straight_->collide(ring.particles, ring.box, offset);
      return;
    }
    curved_->collide(ring.particles, ring.box, offset, tally_);
  }

  std::uint64_t collisions() const { return collisions_ + tally_.fast + tally_.slow; }

private:
  std::optional<StraightDrift> straight_;
  std::optional<collision::DriftPhase> curved_;
  std::uint64_t collisions_ = 0;
  CollisionTally tally_;
};

// Advances the elements to the next epoch and wraps them into the cell. Returns the net number of box widths by which
// guiding centres were wrapped inward, summed over the particles.
std::int64_t move_on(Ring& ring, const hill::Rebase& rebase, double offset) {
  std::int64_t wraps = 0;
  for (Body& body : ring.particles.bodies) {
    rebase(body.elements);
    const Image image = ring.box.image_into_cell(body.elements.guiding_x, body.elements.guiding_y, offset);
    body.elements = ring.box.image_of(body.elements, image, offset);
    wraps -= image.nx;
  }
  return wraps;
}

struct Means {
  double guiding_x = 0.0, vertical = 0.0;
};

// Returns the mean of X over the cell, and the mean of the inclination vectors along their common initial direction,
// sin ζ = sin Ωt.
Means means_of(const Ring& ring, double epoch) {
  Means means;
  for (const Body& body : ring.particles.bodies) {
    means.guiding_x += body.elements.guiding_x;
    means.vertical += body.elements.i_sin * std::sin(epoch) + body.elements.i_cos * std::cos(epoch);
  }
  const double count = static_cast<double>(ring.particles.size());
  return {means.guiding_x / count, means.vertical / count};
}

} // namespace

std::vector<DriftRow> perturbed_ring_drift(const PerturbedRing& request, const std::string& path,
                                           collision::DriftObserver* observer) {
  assert(request.step_orbits > 0.0 && request.samples > 0);
  PerturbedRing settings = request;
  if (path == control_path)
    settings.bunching = settings.inclination = 0.0;
  const double step = two_pi * settings.step_orbits, count = static_cast<double>(settings.count);
  const auto steps = std::llround(settings.orbits / settings.step_orbits);
  Ring ring = make_ring(settings, step);
  Mover mover(settings, path, step, observer);
  const hill::Rebase rebase(unit_frequencies, step);
  const Means first = means_of(ring, 0.5 * step);
  std::vector<DriftRow> rows;
  std::int64_t wraps = 0;
  for (std::int64_t k = 1; k <= steps; ++k) {
    const double epoch = (static_cast<double>(k) - 0.5) * step;
    drive(ring, epoch, step);
    mover.collide(ring, ring.box.offset(2 * k - 1, 0.5 * step));
    wraps += move_on(ring, rebase, ring.box.offset(2 * k + 1, 0.5 * step));
    if (k * settings.samples / steps == (k - 1) * settings.samples / steps)
      continue;
    const Means now = means_of(ring, epoch + step);
    rows.push_back({static_cast<double>(k) * settings.step_orbits, path, settings.step_orbits,
                    now.guiding_x - first.guiding_x + static_cast<double>(wraps) * ring.box.size_x / count,
                    now.vertical - first.vertical, 2.0 * static_cast<double>(mover.collisions()) / count});
  }
  return rows;
}

std::string drift_csv(const std::vector<DriftRow>& rows) {
  std::string text = "orbits,path,step_orbits,mean_guiding_x_r,mean_vertical_r,collisions_per_particle\n";
  for (const DriftRow& row : rows)
    text += fmt::format("{:.9g},{},{:g},{:.9g},{:.9g},{:.9g}\n", row.orbits, row.path, row.step_orbits,
                        row.mean_guiding_x_r, row.mean_vertical_r, row.collisions_per_particle);
  return text;
}

} // namespace keeler::study
