// A ring beside its plain twin: every step starts from one state, and all results must have equal bits.
#pragma once

#include "unit/collision/plain_drift.hpp"
#include "unit/collision/ring.hpp"
#include "unit/collision/same_bits.hpp"

#include <doctest/doctest.h>

namespace keeler::test {

struct Recorder : collision::DriftObserver {
  std::vector<collision::CollisionRecord> records;
  void collided(const collision::CollisionRecord& record) override { records.push_back(record); }
};

/// Takes the records of the last step, carried out in domains.
struct Taker : collision::DriftObserver {
  std::vector<collision::CollisionRecord> records;
  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  std::size_t wants_domains() const override { return static_cast<std::size_t>(threads()); }
  void recorded(std::span<const collision::CollisionRecord> of_step) override {
    records.assign(of_step.begin(), of_step.end());
  }
};

/// Returns the number of leading records that are equal.
inline std::size_t same_records(const std::vector<collision::CollisionRecord>& a,
                                const std::vector<collision::CollisionRecord>& b) {
  std::size_t k = 0;
  while (k < std::min(a.size(), b.size()) && same_bits(a[k], b[k]))
    ++k;
  return k;
}

inline double total_energy(const Ring& ring) {
  double sum = 0.0;
  for (const Body& b : ring.particles.bodies)
    sum += b.mass * epicyclic_energy(b.elements, ring.frequencies);
  for (std::size_t k = 0; k < ring.particles.spins.size(); ++k) {
    const Body& b = ring.particles.bodies[k];
    sum += 0.2 * b.mass * b.radius * b.radius * (ring.particles.spins[k] - Vec3(0.0, 0.0, 1.0)).squaredNorm();
  }
  return sum;
}

/// Returns the size of the terms of the energy, kg m² rad⁻²: its rounding is some 1e-16 of this.
inline double energy_scale(const Ring& ring) {
  double sum = 0.0;
  for (const Body& b : ring.particles.bodies) {
    const Elements& el = b.elements;
    const double vertical = ring.frequencies.nu * el.inclination();
    sum += b.mass * (std::pow(el.eccentricity() + b.radius, 2) + vertical * vertical);
  }
  return sum;
}

class Twin {
public:
  Twin(Ring& ring, const collision::CollisionSettings& settings)
      : ring_(ring), plain_(settings, ring.frequencies, omega, ring.step) {}

  /// Drifts through one step and moves on; returns its collisions. Every other step is not observed event by event, so
  /// that threads may work; then the records are taken at its end.
  std::size_t advance() {
    Particles copy = ring_.particles;
    const bool watched = ring_.steps % 2 == 0;
    Recorder recorder;
    CollisionTally tally, plain_tally;
    const double energy = total_energy(ring_), scale = energy_scale(ring_);
    Taker taker;
    ring_.observer = watched ? static_cast<collision::DriftObserver*>(&recorder) : &taker;
    ring_.collide(tally);
    ring_.observer = nullptr;
    const auto expected = plain_.collide(copy, ring_.box, ring_.epoch_offset(), plain_tally);
    INFO("step ", ring_.steps, ", ", expected.size(), " collisions");
    const std::vector<collision::CollisionRecord>& records = watched ? recorder.records : taker.records;
    CHECK(records.size() == expected.size());
    REQUIRE(same_records(records, expected) == expected.size());
    REQUIRE(same_bits(ring_.particles, copy));
    REQUIRE(same_bits(tally, plain_tally));
    const double unbooked = total_energy(ring_) - energy - epicyclic_gain(tally, ring_.frequencies);
    REQUIRE(std::fabs(unbooked) <= 1e-15 * scale * (10.0 + static_cast<double>(expected.size())));
    last = expected;
    ring_.move_on();
    return expected.size();
  }

  /// Does so many steps.
  std::size_t advance(int steps) {
    std::size_t collisions = 0;
    for (int k = 0; k < steps; ++k)
      collisions += advance();
    return collisions;
  }

  std::vector<collision::CollisionRecord> last; ///< of the last step

private:
  Ring& ring_;
  PlainDrift plain_;
};

} // namespace keeler::test
