#include "gravity_states.hpp"

#include "draws.hpp"

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/simd.hpp>
#include <keeler/diagnostics/force_error.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wakes.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace gravity_states_test {

using namespace keeler;
using namespace keeler::bench;

namespace {

std::vector<Vec3> exact(const Patch& patch, const std::vector<std::size_t>& targets, int rings) {
  return sampled_accelerations(diagnostics::gravity_problem(patch), targets, {rings, true}, choose_instruction_set());
}

double rms_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double difference = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference += (a[k] - b[k]).squaredNorm();
    whole += b[k].squaredNorm();
  }
  return std::sqrt(difference / whole);
}

} // namespace

TEST_CASE("the bench's patch is the example's, two critical wavelengths wide or more") {
  const Scene example = load_scene(KEELER_EXAMPLES "/a-ring-wakes/scene.toml");
  const Scene same = a_ring_scene(example.particles.count, 1), small = a_ring_scene(10, 1);
  CHECK(static_cast<double>(same.particles.count) == doctest::Approx(static_cast<double>(example.particles.count))
                                                         .epsilon(1e-3)); // rounding to whole particles at τ = 0.5
  CHECK(same.size_x == doctest::Approx(example.size_x).epsilon(1e-3));
  CHECK(small.size_x == doctest::Approx(0.5 * example.size_x).epsilon(1e-12));
  for (const Scene* scene : {&same, &small}) {
    CHECK(scene->surface_density() == doctest::Approx(example.surface_density()).epsilon(1e-3));
    CHECK(scene->planet.orbital_frequency == example.planet.orbital_frequency);
    CHECK(scene->particles.velocity_dispersion == example.particles.velocity_dispersion);
    CHECK(scene->collisions.restitution({.speed = 0.02}) == example.collisions.restitution({.speed = 0.02}));
    CHECK(scene->gravity->opening_angle == example.gravity->opening_angle);
    CHECK(scene->time.step == 1e-3); // published costs refer to this step, independent of the example
  }
}

TEST_CASE("the clumped state has wakes, and the forces in its tiles equal those in the patch") {
  PhaseProgress silent({});
  const Patch tile = gravity_state(2400, "clumped", silent).patch;
  REQUIRE(tile.offset > 1.0); // else the tiling tests little
  CHECK(cells::largest_overlap(tile).depth < 1e-12);
  CHECK(find_wakes(diagnostics::mean_autocorrelation(std::span(&tile, 1)), diagnostics::critical_wavelength(tile))
            .amplitude > 0.1);

  const std::vector<std::size_t> targets =
      diagnostics::draw_force_sample(diagnostics::gravity_problem(tile), test::draws(150), 20, 5.0).targets;
  const std::vector<Vec3> of_tile = exact(tile, targets, 2);
  // measured 8e-10: the fits of the far images
  CHECK(rms_difference(exact(tile, targets, 3), of_tile) < 1e-7);
  for (const auto& [nx, ny] : {std::pair<std::size_t, std::size_t>{2, 2}, {3, 3}, {1, 2}, {3, 2}}) {
    const Patch large = initial_conditions::tiled_patch(tile, nx, ny);
    for (const std::size_t copy : {std::size_t{0}, nx * ny - 1}) {
      std::vector<std::size_t> copies;
      for (const std::size_t k : targets)
        copies.push_back(copy * tile.size() + k);                     // tiled.hpp has the order
      CHECK(rms_difference(exact(large, copies, 1), of_tile) < 1e-5); // measured 3e-7: one ring, whose fit is coarser
    }
  }
}

TEST_CASE("every gravity solver on the list is found by its name") {
  for (const std::string& name : gravity_solver_names())
    CHECK(default_gravity_choice(name).solver == name);
  for (const GravityChoice& choice : gravity_choices()) {
    CHECK(make_gravity_solver(choice.settings, std::vector<double>(1000, 1.0), 1e4)->name() == choice.solver);
    CHECK_FALSE(choice.text.empty());
  }
}

} // namespace gravity_states_test
