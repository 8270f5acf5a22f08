// The energy of a patch in its own gravity and its shear stress, against the sum of the lattice's potential over all
// pairs.
#include <keeler/gravity/fft.hpp>

#include "clumped_state.hpp"

#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace energy_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

// Returns the sum over all pairs and images, a particle's own images included: exact up to rounding.
double exact_potential(const ClumpedState& state) {
  const Lattice lattice(state.box, state.offset);
  double sum = 0.0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sum += 0.5 * state.masses[i] * state.masses[i] * lattice.potential(Vec3::Zero());
    for (std::size_t j = 0; j < i; ++j)
      sum += state.masses[i] * state.masses[j] * lattice.potential(state.positions[i] - state.positions[j]);
  }
  return state.problem().newton_g * sum;
}

ClumpedState sheared(ClumpedState state, double strain) {
  for (Vec3& p : state.positions)
    p.y() -= strain * p.x();
  state.offset += strain * state.box.size_x;
  return state;
}

// Returns the derivative of the exact potential by a difference of fourth order.
double exact_stress(const ClumpedState& state) {
  constexpr double h = 1e-3;
  const auto at = [&](double strain) { return exact_potential(sheared(state, strain)); };
  return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}

GravityEnergy by_fft(const ClumpedState& state, double cut) {
  FftSolver solver({3.0, cut}, choose_instruction_set());
  return solver.energy(state.problem());
}

} // namespace

TEST_CASE("potential energy and shear stress are those of the lattice, at any offset") {
  for (const double part : {0.0, 0.3, -0.45}) {
    ClumpedState state = clumped_state(300, 5);
    state.offset = part * state.box.size_y;
    const double potential = exact_potential(state), stress = exact_stress(state);
    // the size of the terms of the stress, which nearly cancel in so few clumps
    double scale = 0.0;
    for (const double m : state.masses)
      scale += m * m / 3.0;
    scale *= state.problem().newton_g;
    const GravityEnergy coarse = by_fft(state, 2.5), fine = by_fft(state, 6.0);
    MESSAGE("offset " << part << ": potential " << potential / scale << ", " << coarse.potential / scale << ", "
                      << fine.potential / scale << "; stress " << stress / scale << ", " << coarse.stress / scale
                      << ", " << fine.stress / scale);
    CHECK(std::fabs(coarse.potential - potential) < 2e-3 * std::fabs(potential));
    CHECK(std::fabs(fine.potential - potential) < 5e-4 * std::fabs(potential));
    CHECK(std::fabs(coarse.stress - stress) < 2e-3 * scale);
    CHECK(std::fabs(fine.stress - stress) < 2e-4 * scale);
  }
}

TEST_CASE("the energy of a patch has equal bits for any number of threads") {
  const ClumpedState state = clumped_state(3000, 2);
  set_threads(1);
  const GravityEnergy one = by_fft(state, 2.5);
  for (const int count : {2, 3}) {
    set_threads(count);
    const GravityEnergy several = by_fft(state, 2.5);
    CHECK(several.potential == one.potential);
    CHECK(several.stress == one.stress);
  }
}

} // namespace energy_test
