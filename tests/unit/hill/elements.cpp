#include <keeler/hill/elements.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

namespace elements_test {

using namespace keeler;
using namespace keeler::hill;

namespace {

Elements random_elements(RandomStream& random) {
  return {random.normal() * 50, random.normal() * 50, random.normal(),
          random.normal(),      random.normal(),      random.normal()};
}

// Integrates Hill's equations by fourth-order Runge–Kutta, as reference for the closed form.
State integrate(State s, const Frequencies& f, double time, int steps) {
  const auto slope = [&](const State& at) {
    State d;
    d.position = at.velocity;
    d.velocity = Vec3(2.0 * at.velocity.y() + (4.0 - f.kappa * f.kappa) * at.position.x(), -2.0 * at.velocity.x(),
                      -f.nu * f.nu * at.position.z());
    return d;
  };
  const auto moved = [](const State& a, const State& d, double h) {
    State b;
    b.position = a.position + h * d.position;
    b.velocity = a.velocity + h * d.velocity;
    return b;
  };
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) {
    const State k1 = slope(s), k2 = slope(moved(s, k1, h / 2)), k3 = slope(moved(s, k2, h / 2)),
                k4 = slope(moved(s, k3, h));
    for (const auto& [d, w] : {std::pair{k1, 1.0}, {k2, 2.0}, {k3, 2.0}, {k4, 1.0}})
      s = moved(s, d, h * w / 6);
  }
  return s;
}

constexpr Frequencies all_frequencies[] = {{1.0, 1.0}, {0.99458, 1.00539}, {1.0, 3.6}, {0.8, 1.3}};

} // namespace

TEST_CASE("sine and cosine by polynomials are accurate to rounding") {
  for (double a = -30.0; a < 30.0; a += 0.00137) {
    double s, c;
    sine_cosine(a, s, c);
    CHECK(std::fabs(s - std::sin(a)) <= 3.4e-16);
    CHECK(std::fabs(c - std::cos(a)) <= 3.4e-16);
  }
}

TEST_CASE("states follow Hill's equations for general kappa and nu") {
  RandomStream random(1, RandomPurpose::velocity, 1);
  for (const Frequencies& f : all_frequencies) {
    const Elements el = random_elements(random);
    const State start = state_at(el, f, Rotation(f, 0.0));
    const State end = state_at(el, f, Rotation(f, 2.5));
    const State twin = integrate(start, f, 2.5, 4000);
    CHECK((end.position - twin.position).norm() < 1e-9);
    CHECK((end.velocity - twin.velocity).norm() < 1e-9);
  }
}

TEST_CASE("elements and states are inverse, at any time after the epoch") {
  RandomStream random(1, RandomPurpose::velocity, 2);
  for (const Frequencies& f : all_frequencies)
    for (const double after : {0.0, -0.003, 0.7}) {
      const Elements el = random_elements(random);
      const Rotation r(f, after);
      const Elements back = elements_from(state_at(el, f, r), f, r) - el;
      for (const double d : {back.guiding_x, back.guiding_y, back.e_cos, back.e_sin, back.i_sin, back.i_cos})
        CHECK(std::fabs(d) < 1e-12 * 200);
    }
}

TEST_CASE("a kick changes the velocity and not the position") {
  RandomStream random(1, RandomPurpose::velocity, 3);
  for (const Frequencies& f : all_frequencies)
    for (const double after : {0.0, -0.01, 0.4}) {
      Elements el = random_elements(random);
      const Rotation r(f, after);
      const State before = state_at(el, f, r);
      const Vec3 dv(random.normal(), random.normal(), random.normal());
      kick(el, dv, f, r);
      const State now = state_at(el, f, r);
      CHECK((now.position - before.position).norm() < 1e-12 * 100);
      CHECK((now.velocity - before.velocity - dv).norm() < 1e-12 * 100);
    }
}

TEST_CASE("the energy of the elements is the Jacobi integral") {
  RandomStream random(1, RandomPurpose::velocity, 4);
  for (const Frequencies& f : all_frequencies) {
    const Elements el = random_elements(random);
    const State s = state_at(el, f, Rotation(f, 1.3));
    const double x = s.position.x(), z = s.position.z(), k2 = f.kappa * f.kappa;
    const Vec3 c = peculiar_velocity(el, f, Rotation(f, 1.3));
    CHECK((c - s.velocity - Vec3(0.0, f.shear() * x, 0.0)).norm() < 1e-13 * (c.norm() + std::fabs(x)));
    const double own = 0.5 * c.squaredNorm() + f.shear() / k2 * c.y() * c.y() + 0.5 * f.nu * f.nu * z * z;
    CHECK(epicyclic_energy(el, f) == doctest::Approx(own).epsilon(1e-12));
    // with the contribution of the guiding centre it is the Jacobi energy
    const double jacobi = 0.5 * s.velocity.squaredNorm() - f.shear() * x * x + 0.5 * f.nu * f.nu * z * z;
    const double guiding = 0.25 * f.shear() * k2 * el.guiding_x * el.guiding_x;
    CHECK(epicyclic_energy(el, f) - guiding == doctest::Approx(jacobi).epsilon(1e-12));
  }
}

TEST_CASE("re-basing 10^4 orbits of 1000 steps leaves a random walk of roundings, no drift") {
  // 10^7 roundings of relative size <= 1.1e-16 walk to about 3.5e-13; a drift of one unit per step would give 1e-9.
  const Frequencies f{0.99458, 1.00539};
  const double h = two_pi * 1e-3;
  const Elements first{0.0, 3.0, 1.2, -0.4, 0.3, 0.9};
  Elements el = first;
  const Rebase rebase(f, h);
  constexpr long steps = 10'000'000;
  for (long k = 0; k < steps; ++k)
    rebase(el);
  const auto expect = [&](double frequency, double c, double s) {
    // the angle per step is the rounded product, as in the code
    const long double angle =
        std::fmod(static_cast<long double>(frequency * h) * steps, 2.0L * std::numbers::pi_v<long double>);
    return std::pair{static_cast<double>(c * std::cos(angle) - s * std::sin(angle)),
                     static_cast<double>(s * std::cos(angle) + c * std::sin(angle))};
  };
  const auto [ec, es] = expect(f.kappa, first.e_cos, first.e_sin);
  const auto [ic, is] = expect(f.nu, first.i_cos, first.i_sin);
  CHECK(std::fabs(el.e_cos - ec) < 2e-12);
  CHECK(std::fabs(el.e_sin - es) < 2e-12);
  CHECK(std::fabs(el.i_cos - ic) < 2e-12);
  CHECK(std::fabs(el.i_sin - is) < 2e-12);
  CHECK(el.guiding_x == 0.0);
  CHECK(el.guiding_y == 3.0);
}

} // namespace elements_test
