// A patch that moves on step by step, as a run does: drift with collisions, next epoch, back into the cell; and kicks
// between steps, when a test wants some.
#pragma once

#include "unit/collision/scenario.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/particles/patch.hpp>

#include <algorithm>

namespace keeler::test {

/// Carries out the contacts in so many domains, even if they are few.
struct InDomains final : collision::DriftObserver {
  bool wants_events() const override { return false; }
  std::size_t wants_domains() const override { return count > 0 ? count : static_cast<std::size_t>(threads()); }
  std::size_t count = 0; ///< 0: one for each thread
};

struct Ring {
  Particles particles;
  ShearingBox box;
  Frequencies frequencies;
  double step;
  collision::DriftPhase drift;
  CollisionTally tally;
  std::int64_t steps = 0;
  bool keeps_neighbours = false; ///< keeps neighbour lists over several steps, as a run does
  bool undisturbed = false;      ///< true if particles have only moved on since the last drift
  collision::DriftObserver* observer = nullptr;
  InDomains in_domains;

  Ring(const Patch& patch, const collision::CollisionSettings& settings, double step_length)
      : particles(particles_from(patch, 0.5 * step_length)), box(patch.box), frequencies(patch.frequencies),
        step(step_length), drift(settings, patch.frequencies, omega, step_length) {}

  double epoch_offset() const { return box.offset(2 * steps + 1, 0.5 * step); }

  void advance() {
    collide(tally);
    move_on();
  }

  /// Carries out one drift, in domains if there are several threads, unless there is another observer.
  void collide(CollisionTally& into) {
    drift.observe(observer ? observer : &in_domains);
    drift.collide(particles, box, epoch_offset(), into, undisturbed);
    undisturbed = false;
  }

  void move_on() {
    ++steps;
    const double offset = epoch_offset();
    const hill::Rebase rebase(frequencies, step);
    for (Body& body : particles.bodies) {
      Elements& el = body.elements;
      rebase(el);
      el = box.image_of(el, box.image_into_cell(el.guiding_x, el.guiding_y, offset), offset);
    }
    const hill::FixedRotation stars(step);
    for (Vec3& spin : particles.spins)
      stars.turn(spin.y(), spin.x());
    undisturbed = keeps_neighbours;
  }

  /// Kicks each particle at random, by at most `largest` (m rad⁻¹), at the boundary between steps.
  void kick_all(double largest) {
    const Rotation rotation(frequencies, -0.5 * step);
    for (std::size_t k = 0; k < particles.size(); ++k) {
      RandomStream random(static_cast<std::uint64_t>(steps), RandomPurpose::velocity, particles.ids[k]);
      const Vec3 dv(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0);
      kick(particles.bodies[k].elements, largest / std::sqrt(3.0) * dv, frequencies, rotation);
    }
    undisturbed = false;
  }

  /// Returns the patch at the present boundary between steps.
  Patch patch() const {
    return make_patch(particles, box, box.offset(2 * steps, 0.5 * step), frequencies, -0.5 * step);
  }
};

/// Puts particles into the memory order of others with the same ids 0, 1, 2 …
inline void in_order_of(Particles& particles, const Particles& others) {
  std::vector<Body> bodies(particles.size());
  for (std::size_t k = 0; k < particles.size(); ++k)
    bodies[particles.ids[k]] = particles.bodies[k];
  for (std::size_t k = 0; k < particles.size(); ++k)
    particles.bodies[k] = bodies[others.ids[k]];
  particles.ids = others.ids;
}

/// Returns the bodies in the order of their ids, to compare states bit by bit.
inline std::vector<Body> by_id(const Particles& particles) {
  std::vector<std::size_t> places(particles.size());
  for (std::size_t k = 0; k < places.size(); ++k)
    places[k] = k;
  std::sort(places.begin(), places.end(),
            [&](std::size_t a, std::size_t b) { return particles.ids[a] < particles.ids[b]; });
  std::vector<Body> bodies;
  for (const std::size_t k : places)
    bodies.push_back(particles.bodies[k]);
  return bodies;
}

} // namespace keeler::test
