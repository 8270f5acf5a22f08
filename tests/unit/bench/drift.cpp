#include <keeler/bench/drift.hpp>

#include <doctest/doctest.h>

namespace drift_test {

using namespace keeler;
using namespace keeler::bench;

TEST_CASE("the bench times an equilibrium") {
  DriftBenchSettings settings;
  settings.count = 1000;
  settings.step_orbits = 5e-3;
  settings.repeats = 2;
  const DriftBench few = bench_drift(settings);
  CHECK(few.timed.ns_per_particle_step > 0.0);
  CHECK(few.ns_per_call > 0.0);
  // the equilibrium of τ = 0.5, ε = 0.5: c_x 2.175 rΩ, 9.4 collisions; a snapshot of 1000 particles scatters
  CHECK(few.dispersion_r_omega == doctest::Approx(2.175).epsilon(0.12));
  const auto per_particle_orbit = [&](const DriftBench& bench) {
    return 2.0 * bench.timed.per_particle_step(bench.timed.collisions) / settings.step_orbits;
  };
  CHECK(per_particle_orbit(few) == doctest::Approx(9.4).epsilon(0.25));
  settings.all_pairs = true;
  const DriftBench all = bench_drift(settings);
  CHECK(all.calls_per_particle_step > 10.0 * few.calls_per_particle_step);
  CHECK(all.timed.collisions == few.timed.collisions); // the same collisions
}

} // namespace drift_test
