// Piles of grains in the estimate of a run's cost: on moonlets that hold grains, and aggregates of a thin ring.
// docs/dev/estimate.md gives the runs to which they were fitted.
#pragma once

#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler::advice {

class GrainPiles {
public:
  /// Constructs the piles of a fresh start of this scene. They form on the moonlets of the scene, or on the largest
  /// body of a list of sizes. There are no piles without self-gravity between particles.
  explicit GrainPiles(const Scene& scene);

  /// Returns the number of grains in piles after `orbits`. Precondition: orbits ≥ 0.
  double grains(double orbits) const;

  /// Returns the integral of grains() from the start to `orbits`.
  double grain_orbits(double orbits) const;

private:
  void add_moonlets(const Scene& scene);
  void add_aggregates(const Scene& scene);

  struct Moonlet {
    double near = 0.0;     // grains per squared Hill radius
    double capacity = 0.0; // grains that it can hold
  };
  std::vector<Moonlet> moonlets_;
  double count_ = 0.0, gathering_ = 0.0; // particles; particles that form aggregates
  double half_orbits_ = 1.0;             // time until half of them have
};

} // namespace keeler::advice
