// The memory of a run is bounded, by the estimate of `keeler check`.
#include "draws.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/collision/costs.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

namespace memory_test {

using namespace keeler;

namespace {

// Optical depth 1.
Scene scene_of(std::size_t count, double step) {
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [{0}, {0}]
[particles]
count = {1}
density = 900.0
velocity_dispersion = 2.0
sizes = {{ law = "equal", radius = 1.0 }}
[time]
step = {2}
end = 1.0
)",
                                 std::sqrt(pi * static_cast<double>(count)), count, step),
                     "test scene");
}

} // namespace

TEST_CASE("the drift phase holds no more than 460 bytes a particle, 660 on threads, and a scene's estimate has room "
          "for them") {
  constexpr std::size_t count = 20000, large = 2000000;
  constexpr double patch = 9 * 8.0; // a copy of a particle for output: r, v, R, m and id
  const Patch start = initial_patch(scene_of(count, 1e-3));
  const int before = threads();
  for (const double step : {1e-3, 1e-2})
    for (const int several : {1, 2}) {
      CAPTURE(step);
      CAPTURE(several);
      set_threads(several);
      const Scene scene = scene_of(count, step);
      Simulation simulation(scene, start);
      for (std::uint64_t k = 0; k < test::draws(30); ++k)
        simulation.advance();
      const auto held = static_cast<double>(simulation.drift().costs().bytes_per_particle);
      CHECK(held > 100.0); // bodies, ids and lines alone
      CHECK(held <= (several > 1 ? 660.0 : 460.0));
      const double memory = 1e6 * advice::derive(scene).memory_mb;
      CHECK(memory >= held * count);
      // beyond a constant; a snapshot's copy is extra
      const double more =
          (1e6 * advice::derive(scene_of(large, step)).memory_mb - memory) / static_cast<double>(large - count);
      CHECK(more >= held + patch);
    }
  set_threads(before);
}

} // namespace memory_test
