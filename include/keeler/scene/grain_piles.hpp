// Piles of grains that the estimate of a run's cost reckons with: on moonlets that hold grains, and the aggregates of a
// thin ring. docs/dev/estimate.md says what they were fitted to.
#pragma once

#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler {

class GrainPiles {
public:
  /// The piles of a fresh start of this scene. Moonlets are its own, or the largest body of a list of sizes. None
  /// without self-gravity between particles.
  explicit GrainPiles(const Scene& scene);

  /// Returns how many grains lie in piles after that many orbits.
  double grains(double orbits) const;

  /// Returns the integral of grains() over that many orbits from the start.
  double grain_orbits(double orbits) const;

private:
  void add_moonlets(const Scene& scene);
  void add_aggregates(const Scene& scene);

  struct Moonlet {
    double near = 0.0; // grains of a square of its Hill radius
    double most = 0.0; // grains that it can hold
  };
  std::vector<Moonlet> moonlets_;
  double count_ = 0.0, gathering_ = 0.0; // particles; those that gather in aggregates
  double half_orbits_ = 1.0;             // until half of them have
};

} // namespace keeler
