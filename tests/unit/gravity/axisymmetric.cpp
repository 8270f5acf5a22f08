// Radial self-gravity against the exact field of one wave, and against the plain sum over all waves and particles.
#include <keeler/gravity/axisymmetric.hpp>

#include "clumped_state.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <complex>

namespace axisymmetric_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

// Returns 2π G Σ_n i S_n exp(i k_n x) + c.c., S_n summed particle by particle.
std::vector<double> by_plain_sums(const ClumpedState& state, int waves) {
  const GravityProblem p = state.problem();
  std::vector<double> pulls(state.positions.size());
  for (int n = 1; n <= waves; ++n) {
    const double k = two_pi * n / state.box.size_x;
    std::complex<double> amplitude = 0.0; // S_n
    for (std::size_t j = 0; j < pulls.size(); ++j)
      amplitude += state.masses[j] / state.box.area() * std::polar(1.0, -k * state.positions[j].x());
    for (std::size_t j = 0; j < pulls.size(); ++j)
      pulls[j] -= 4.0 * pi * p.newton_g * std::imag(amplitude * std::polar(1.0, k * state.positions[j].x()));
  }
  return pulls;
}

double plain_potential(const ClumpedState& state, int waves) {
  double sum = 0.0;
  for (int n = 1; n <= waves; ++n) {
    const double k = two_pi * n / state.box.size_x;
    std::complex<double> amplitude = 0.0;
    for (std::size_t j = 0; j < state.positions.size(); ++j)
      amplitude += state.masses[j] / state.box.area() * std::polar(1.0, -k * state.positions[j].x());
    sum -= two_pi * state.problem().newton_g * state.box.area() * std::norm(amplitude) / k;
  }
  return sum;
}

// Particles at even spacing, their masses modulated by one wave, at any height and position along the orbit.
ClumpedState one_wave(int n, double amplitude) {
  constexpr std::size_t count = 400;
  ClumpedState state;
  state.box = {600.0, 90.0, 1.5, 0.0};
  for (std::size_t k = 0; k < count; ++k) {
    const double x = (static_cast<double>(k) + 0.25) / count * state.box.size_x - 300.0;
    state.positions.emplace_back(x, std::fmod(37.0 * static_cast<double>(k), 90.0) - 45.0,
                                 static_cast<double>(k % 7) - 3.0);
    state.masses.push_back(1e4 * (1.0 + amplitude * std::cos(two_pi * n * x / state.box.size_x)));
    state.ids.push_back(k);
  }
  return state;
}

} // namespace

// A thin sheet with Σ = ⟨Σ⟩ + S cos kx has Φ = −(2π G S / |k|) exp(−|k||z|) cos kx (Binney & Tremaine 2008, eq. 5.161):
// in its plane the acceleration is −2π G S sin kx.
TEST_CASE("one wave of the surface density pulls as a thin sheet does") {
  const double amplitude = 0.2;
  for (const int n : {1, 3, 12}) {
    const ClumpedState state = one_wave(n, amplitude);
    AxisymmetricSolver solver(50.0); // 12 waves
    const std::vector<Vec3> a = accelerations(solver, state.problem());
    const double sheet = amplitude * 400 * 1e4 / state.box.area(), pull = two_pi * state.problem().newton_g * sheet;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double exact = -pull * std::sin(two_pi * n * state.positions[k].x() / state.box.size_x);
      CHECK(std::fabs(a[k].x() - exact) < 2e-8 * pull); // the shortest wave has the largest error, 5e-9 each way
      CHECK(a[k].y() == 0.0);
      CHECK(a[k].z() == 0.0);
    }
  }
  const ClumpedState shorter = one_wave(13, amplitude);
  AxisymmetricSolver solver(50.0);
  for (const Vec3& a : accelerations(solver, shorter.problem())) // beyond the cut: nothing
    CHECK(a.norm() < 1e-8 * two_pi * shorter.problem().newton_g * 400 * 1e4 / shorter.box.area());
}

TEST_CASE("forces and energy are those of the plain sum over waves and particles") {
  for (const double size_range : {1.0, 100.0}) {
    const ClumpedState state = clumped_state(1200, 3, size_range);
    for (const int waves : {1, 7, 40}) {
      AxisymmetricSolver solver(state.box.size_x / (waves + 0.5));
      const std::vector<Vec3> a = accelerations(solver, state.problem());
      const std::vector<double> exact = by_plain_sums(state, waves);
      double error = 0.0, whole = 0.0;
      for (std::size_t k = 0; k < a.size(); ++k) {
        error += std::pow(a[k].x() - exact[k], 2);
        whole += exact[k] * exact[k];
      }
      CHECK(std::sqrt(error / whole) < 1e-8);
      const GravityEnergy energy = solver.energy(state.problem());
      CHECK(energy.potential == doctest::Approx(plain_potential(state, waves)).epsilon(1e-8));
      CHECK(energy.stress == 0.0);
    }
  }
}

TEST_CASE("radial forces conserve momentum and are the gradient of the energy") {
  ClumpedState state = clumped_state(800, 4, 30.0);
  AxisymmetricSolver solver(12.0);
  const std::vector<Vec3> a = accelerations(solver, state.problem());
  double sum = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += state.masses[k] * a[k].x();
    size += state.masses[k] * std::fabs(a[k].x());
  }
  CHECK(std::fabs(sum) < 1e-13 * size);

  constexpr double step = 1e-3; // m
  const std::size_t heaviest =
      static_cast<std::size_t>(std::max_element(state.masses.begin(), state.masses.end()) - state.masses.begin());
  double potential[2];
  for (const int side : {0, 1}) {
    ClumpedState moved = state;
    moved.positions[heaviest].x() += (2 * side - 1) * step;
    potential[side] = solver.energy(moved.problem()).potential;
  }
  const double slope = (potential[1] - potential[0]) / (2.0 * step);
  CHECK(slope == doctest::Approx(-state.masses[heaviest] * a[heaviest].x()).epsilon(1e-5));
}

TEST_CASE("a lone particle has no self-force, and a box without waves is refused") {
  ClumpedState state = clumped_state(1, 1);
  AxisymmetricSolver solver(state.box.size_x / 9.0);
  const double scale = state.problem().newton_g * state.masses[0] / state.box.area();
  CHECK(std::fabs(accelerations(solver, state.problem())[0].x()) < 1e-12 * scale);
  AxisymmetricSolver too_long(state.box.size_x * 1.01);
  CHECK_THROWS_AS(accelerations(too_long, state.problem()), UsageError);
  for (const double wavelength : {1e-18, 1e-8 * state.box.size_x, 1e-300}) {
    AxisymmetricSolver too_short(wavelength);
    CHECK_THROWS_WITH_AS(accelerations(too_short, state.problem()), doctest::Contains("too short"), UsageError);
    CHECK_THROWS_AS(accelerations(too_short, state.problem()), UsageError); // and again: no state is left behind
  }
  state.positions[0].x() = NAN;
  CHECK_THROWS_AS(accelerations(solver, state.problem()), InvariantError);
}

} // namespace axisymmetric_test
