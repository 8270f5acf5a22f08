// A run of 10^5 orbits: what must not drift.
#include "unit/collision/ring.hpp"
#include "unit/collision/spheres.hpp"

#include <doctest/doctest.h>

namespace long_run_test {

using namespace keeler;

TEST_CASE("10^5 orbits without drift of phase or mean X") {
  // phase and length of an epicycle: 10^7 roundings of e ulp/2 = 2e-16 walk to 7e-13; a drift would give 2e-9
  const Frequencies f{0.99458, 1.00539};
  const double step = two_pi * 1e-2;
  constexpr int steps = 10'000'000;
  const hill::Rebase rebase(f, step);
  Elements el{0.0, 0.0, 2.0, 0.0, 0.0, 2.0};
  for (int k = 0; k < steps; ++k)
    rebase(el);
  const auto angle = [&](double frequency) {
    return std::fmod(static_cast<long double>(frequency * step) * steps, 2.0L * std::numbers::pi_v<long double>);
  };
  CHECK(std::fabs(el.e_cos - 2.0 * static_cast<double>(std::cos(angle(f.kappa)))) < 5e-12);
  CHECK(std::fabs(el.e_sin - 2.0 * static_cast<double>(std::sin(angle(f.kappa)))) < 5e-12);
  CHECK(std::fabs(el.i_cos - 2.0 * static_cast<double>(std::cos(angle(f.nu)))) < 5e-12);
  CHECK(std::fabs(el.i_sin - 2.0 * static_cast<double>(std::sin(angle(f.nu)))) < 5e-12);

  // Σ X, which collisions keep, and which changes by the box's length where a particle is wrapped
  const std::vector<test::Sphere> spheres{
      {{2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{-2.0, 0.0, 0.0}}, {{0.0, 3.0, 0.0}, {0.0, 1.0, 0.0}}};
  test::Ring ring(test::patch_of(spheres, 9.0, 9.0), {}, two_pi * 0.25);
  ring.keeps_neighbours = true;
  const auto sum = [&] {
    double total = 0.0;
    for (const Body& b : ring.particles.bodies)
      total += b.elements.guiding_x;
    return total;
  };
  const double start = sum();
  while (ring.steps < 400'000)
    ring.advance();
  const auto collisions = static_cast<double>(ring.tally.fast + ring.tally.slow);
  CHECK(collisions > 5e4);
  // roundings of 3e-16 or so, some to a collision, that walk
  CHECK(std::fabs(std::remainder(sum() - start, ring.box.size_x)) < 5e-15 * std::sqrt(collisions));
}

} // namespace long_run_test
