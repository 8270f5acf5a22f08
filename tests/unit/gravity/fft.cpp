#include <keeler/gravity/fft.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/gravity/direct.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace fft_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

// Returns the exact periodic force on many particles in a layer, to 1e-6 G Σ with three rings.
std::vector<Vec3> exact(const ClumpedState& state, int rings = 1) {
  DirectSolver solver({rings, true}, choose_instruction_set());
  return accelerations(solver, state.problem());
}

std::vector<Vec3> by_fft(const ClumpedState& state, const FftSettings& settings) {
  FftSolver solver(settings, choose_instruction_set());
  return accelerations(solver, state.problem());
}

double error_of(const ClumpedState& state, const FftSettings& settings) {
  return rms_error(by_fft(state, settings), exact(state));
}

// Returns random positions in a layer, without overlaps.
ClumpedState random_state(std::size_t count, std::uint64_t seed, ShearingBox box, double height) {
  ClumpedState state;
  state.box = box;
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(seed, RandomPurpose::position, k);
    Vec3 p;
    bool free = false;
    while (!free) {
      p.x() = (random.uniform() - 0.5) * box.size_x;
      p.y() = (random.uniform() - 0.5) * box.size_y;
      p.z() = (random.uniform() - 0.5) * height;
      free = true;
      for (const Vec3& other : state.positions)
        free = free && (other - p).norm() > 2.0;
    }
    state.positions.push_back(p);
    state.masses.push_back(2513.0);
    state.radii.push_back(1.0);
    state.ids.push_back(3 * k + 1);
  }
  return state;
}

// Returns two bodies at a distance; their position and direction depend on k.
ClumpedState pair_of(double distance, int k) {
  ClumpedState state;
  state.box = {90.0, 80.0, 1.5, 0.0};
  RandomStream random(5, RandomPurpose::position, static_cast<std::uint64_t>(k));
  Vec3 along;
  for (int axis = 0; axis < 3; ++axis)
    along[axis] = random.normal();
  Vec3 first = place_evenly(random, 70.0);
  first.z() = 6.0 * random.uniform();
  state.positions = {first, first + distance * along.normalized()};
  state.masses = {1.0, 1.0};
  state.ids = {1, 2};
  return state;
}

} // namespace

TEST_CASE("a particle far above any layer makes no mesh of gigabytes: it is refused") {
  ClumpedState state = random_state(100, 1, {40.0, 30.0, 1.5, 0.0}, 4.0);
  state.positions[3].z() = 1.001e3 * std::min(state.box.size_x, state.box.size_y);
  CHECK_THROWS_WITH_AS(by_fft(state, {}), doctest::Contains("sides of the box away from the mid-plane"),
                       InvariantError);
}

TEST_CASE("the mesh solver's error in even and in clumped states is what its settings promise, at any offset") {
  for (const bool clumped : {false, true}) {
    ClumpedState state = clumped ? clumped_state(1500, 1) : random_state(600, 2, {80.0, 60.0, 1.5, 0.0}, 12.0);
    for (const double part : {0.0, 0.3, 0.5, 0.97}) {
      state.offset = part * state.box.size_y;
      const double coarse = error_of(state, {4.0, 2.25}), fine = error_of(state, {3.0, 3.0});
      MESSAGE(std::string(clumped ? "clumped" : "even")
              << ", offset " << part << " L_y, error at 4 m and 2.25: " << coarse << ", at 3 m and 3: " << fine);
      CHECK(coarse < 3e-3);
      CHECK(fine < 1.3e-3);
    }
  }
}

TEST_CASE("the error falls with the cut and with the spacing, towards the exact periodic force") {
  const ClumpedState state = clumped_state(600, 3);
  const std::vector<Vec3> reference = exact(state, 3);
  double last = 1.0;
  for (const double cut : {1.5, 2.0, 3.0, 4.5, 7.0}) {
    const double error = rms_error(by_fft(state, {3.0, cut}), reference);
    MESSAGE("3 m, cut " << cut << ": " << error);
    CHECK(error < 0.62 * last);
    last = error;
  }
  const double with_radius_9[] = {rms_error(by_fft(state, {4.0, 2.25}), reference),
                                  rms_error(by_fft(state, {2.0, 4.5}), reference),
                                  rms_error(by_fft(state, {1.0, 9.0}), reference)};
  MESSAGE("cloud of 9 m, spacing 4, 2, 1 m: " << with_radius_9[0] << " " << with_radius_9[1] << " "
                                              << with_radius_9[2]);
  CHECK(with_radius_9[1] < 0.3 * with_radius_9[0]);
  CHECK(with_radius_9[2] < 0.3 * with_radius_9[1]);
  CHECK(with_radius_9[2] < 5e-5);
}

TEST_CASE("settings for a required error keep it") {
  for (const double size_range : {1.0, 10.0}) {
    const ClumpedState state = clumped_state(600, 14, size_range);
    const std::vector<Vec3> reference = exact(state, 3);
    for (const double wanted : {5e-3, 2e-3, 5e-4, 1e-4}) {
      const FftSettings settings{cheapest_spacing * std::sqrt(state.box.area() / 600),
                                 cut_for(wanted, mass_spread(state.masses))};
      const double error = rms_error(by_fft(state, settings), reference);
      MESSAGE("wanted " << wanted << ": " << settings.spacing << " m, cut " << settings.cut << ", error " << error);
      CHECK(error < wanted);
      CHECK(error > 0.1 * wanted); // or it would cost more than necessary
    }
  }
}

TEST_CASE("the cut grows with the accuracy required and with the spread of masses, within its limits") {
  for (const double spread : {1.0, 1.5, 4.0, 20.0, 1e4}) {
    double last = 1.9999;
    for (double wanted = 0.1; wanted > 0.99e-5; wanted *= 0.99) {
      const double cut = cut_for(wanted, spread);
      CHECK(cut >= last);
      CHECK(cut < 1.03 * std::max(2.0, last)); // no jumps
      CHECK(cut <= 16.0);
      CHECK(cut >= cut_for(wanted, 0.7 * spread));
      last = cut;
    }
  }
}

TEST_CASE("the spread of masses is that of the distribution, with equal bits in any order") {
  CHECK(mass_spread({}) == 1.0);
  CHECK(mass_spread(std::vector<double>(10, 3.0)) == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(mass_spread(std::vector<double>{1.0, 3.0}) == doctest::Approx(std::sqrt(5.0) / 2.0).epsilon(1e-15));
  std::vector<double> masses = clumped_state(1000, 7, 10.0).masses;
  const double spread = mass_spread(masses);
  CHECK(spread > 1.5);
  std::reverse(masses.begin(), masses.begin() + 700);
  CHECK(mass_spread(masses) == spread);
}

TEST_CASE("two spheres in contact attract each other as Newton has it") {
  FftSolver solver({4.0, 2.25}, choose_instruction_set());
  double square = 0.0, worst = 0.0;
  for (int k = 0; k < 200; ++k) {
    const ClumpedState state = pair_of(2.0, k);
    const std::vector<Vec3> a = accelerations(solver, state.problem()), b = exact_pair_by_pair(state, 1e-10);
    const double error = (a[0] - b[0]).norm() / b[0].norm();
    square += error * error / 200;
    worst = std::max(worst, error);
  }
  MESSAGE("in contact at 4 m and 2.25: rms " << std::sqrt(square) << ", worst " << worst);
  CHECK(std::sqrt(square) < 1.5e-3);
  CHECK(worst < 5e-3);
}

TEST_CASE("the error of a pair is small at all distances, from well inside the cloud to well outside it") {
  FftSolver solver({4.0, 2.25}, choose_instruction_set());
  for (const double distance : {0.5, 4.0, 8.9, 9.1, 14.0, 40.0})
    for (int k = 0; k < 20; ++k) {
      const ClumpedState state = pair_of(distance, k);
      const std::vector<Vec3> a = accelerations(solver, state.problem()), b = exact_pair_by_pair(state, 1e-10);
      const double contact = state.problem().newton_g / 4.0; // the attraction of spheres of 1 m in contact
      CHECK((a[0] - b[0]).norm() < 5e-3 * contact + 1e-5 * b[0].norm());
    }
}

TEST_CASE("waves in the surface density, and the sheet itself, are those of theory") {
  // 96 × 96 bodies of a lattice that closes across the sheared edges, lying on a plane, felt by bodies without mass
  constexpr int side = 96;
  for (const double part : {0.0, 0.3, 0.5}) {
    ClumpedState state;
    state.box = {120.0, 100.0, 1.5, 0.0};
    state.offset = part * state.box.size_y;
    const double offset = std::remainder(state.offset, state.box.size_y);
    const double ky = 2.0 * pi * 2 / state.box.size_y,
                 kx = 2.0 * pi / state.box.size_x + ky * offset / state.box.size_x;
    const double k = std::hypot(kx, ky), sigma = 400.0;
    const auto add = [&](const Vec3& p, double mass) {
      state.positions.push_back(p);
      state.masses.push_back(mass);
      state.ids.push_back(state.ids.size());
    };
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double x = (i + 0.5) / side - 0.5;
        Vec3 p(x * state.box.size_x, (j + 0.5) / side * state.box.size_y - x * offset, 0.7);
        add(p, sigma * state.box.area() / (side * side) * (1.0 + 0.5 * std::cos(kx * p.x() + ky * p.y())));
      }
    const std::size_t sources = state.positions.size();
    for (int i = 0; i < 60; ++i) {
      RandomStream random(9, RandomPurpose::position, static_cast<std::uint64_t>(i));
      Vec3 p = place_evenly(random, 100.0);
      p.z() = 0.7 + (i % 2 == 0 ? 1 : -1) * (4.0 + 20.0 * random.uniform()); // at least some lattice spacings away
      add(p, 0.0);
    }
    const double sheet = 2.0 * pi * state.problem().newton_g * sigma;
    for (const FftSettings& settings : {FftSettings{4.0, 2.25}, FftSettings{4.0, 2.25, false}}) {
      const std::vector<Vec3> a = by_fft(state, settings);
      double worst = 0.0;
      for (std::size_t p = sources; p < a.size(); ++p) {
        const Vec3& at = state.positions[p];
        if (!settings.short_range && std::fabs(at.z() - 0.7) < 9.0)
          continue; // inside the clouds the mesh alone gives a smoothed field
        const double height = at.z() - 0.7, phase = kx * at.x() + ky * at.y();
        const double wave = 0.5 * std::exp(-k * std::fabs(height));
        const Vec3 theory = -sheet * Vec3(kx / k * wave * std::sin(phase), ky / k * wave * std::sin(phase),
                                          std::copysign(1.0 + wave * std::cos(phase), height));
        worst = std::max(worst, (a[p] - theory).norm() / sheet);
      }
      MESSAGE("offset " << part << " L_y, " << std::string(settings.short_range ? "whole" : "mesh alone") << ": worst "
                        << worst);
      CHECK(worst < 2e-3);
    }
  }
}

TEST_CASE("the mesh solver exerts no net force") {
  for (const double size_range : {1.0, 1000.0}) {
    const ClumpedState state = clumped_state(2000, 4, size_range);
    const std::vector<Vec3> a = by_fft(state, {4.0, 2.25});
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      sum += state.masses[k] * a[k];
      whole += state.masses[k] * a[k].norm();
    }
    CHECK(sum.norm() < 1e-7 * whole); // masses are rounded to single precision on the way
  }
}

TEST_CASE("forces are continuous at a wrap of the offset and at the edge of the cell") {
  ClumpedState state = clumped_state(1500, 5);
  const FftSettings settings{4.0, 2.25};
  state.offset = 1e-9;
  const std::vector<Vec3> after = by_fft(state, settings);
  state.offset = state.box.size_y - 1e-9;
  CHECK(rms_error(by_fft(state, settings), after) < 1e-5); // single precision
  state.offset = 0.5 * state.box.size_y - 1e-9;
  const std::vector<Vec3> before_half = by_fft(state, settings);
  state.offset = 0.5 * state.box.size_y + 1e-9;
  CHECK(rms_error(by_fft(state, settings), before_half) < 1e-5);

  state.offset = 0.37 * state.box.size_y;
  for (const int axis : {0, 1}) {
    ClumpedState inside = state, outside = state;
    const double edge = 0.5 * (axis == 0 ? state.box.size_x : state.box.size_y);
    inside.positions[40] = outside.positions[40] = Vec3(3.0, 5.0, 9.0);
    inside.positions[40][axis] = edge - 1e-9;
    outside.positions[40][axis] = edge + 1e-9;
    const std::vector<Vec3> a = by_fft(inside, settings), b = by_fft(outside, settings);
    double jump = 0.0, mean = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      jump = std::max(jump, (a[k] - b[k]).norm());
      mean += a[k].norm() / static_cast<double>(a.size());
    }
    MESSAGE("crossing an edge, largest jump by the mean force: " << jump / mean);
    CHECK(jump < 5e-3 * mean); // weights in ghosts go to other rows: the error differs
  }
}

TEST_CASE("the edges of the cell exert no mean force") {
  ClumpedState state = clumped_state(2500, 6);
  const FftSettings settings{4.0, 2.25};
  for (const double part : {0.0, 0.3, 0.5}) {
    state.offset = part * state.box.size_y;
    const std::vector<Vec3> a = by_fft(state, settings), b = exact(state);
    Vec3 mean = Vec3::Zero();
    double square = 0.0, near_edge = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      square += b[k].head<2>().squaredNorm() / static_cast<double>(a.size());
      const double from_edge = 0.5 * state.box.size_x - std::fabs(state.positions[k].x());
      if (from_edge < 0.05 * state.box.size_x) {
        mean += std::copysign(1.0, state.positions[k].x()) * (a[k] - b[k]);
        near_edge += 1.0;
      }
    }
    MESSAGE("offset " << part << " L_y: mean error near the edge by the rms "
                      << mean.norm() / near_edge / std::sqrt(square));
    CHECK(mean.head<2>().norm() / near_edge < 1e-3 * std::sqrt(square));
  }
}

TEST_CASE("memory order, threads, instruction sets and a mesh solver's past change no bit") {
  const ClumpedState state = clumped_state(2003, 7, 10.0);
  ClumpedState other = state;
  for (std::size_t k = 0; k < 2003; ++k) {
    const std::size_t from = (k * 7919 + 13) % 2003; // 7919 is prime
    other.positions[k] = state.positions[from];
    other.masses[k] = state.masses[from];
    other.ids[k] = state.ids[from];
  }
  const FftSettings settings{3.0, 2.5};
  FftSolver solver(settings, choose_instruction_set());
  const std::vector<Vec3> fresh = accelerations(solver, state.problem());
  accelerations(solver, clumped_state(2003, 8).problem());
  accelerations(solver, clumped_state(50, 8).problem());
  const std::vector<Vec3> later = accelerations(solver, other.problem());
  for (std::size_t k = 0; k < 2003; ++k)
    CHECK(later[k] == fresh[(k * 7919 + 13) % 2003]);

  const int before = threads();
  for (const int count : {1, 2, 3}) {
    set_threads(count);
    CHECK(by_fft(state, settings) == fresh);
  }
  set_threads(before);
  for (const InstructionSet set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512})
    if (supports(set)) {
      FftSolver own(settings, set);
      CHECK(accelerations(own, state.problem()) == fresh);
    }
}

TEST_CASE("boxes of a few radii, long ones and tall ones; none, one and two particles") {
  struct Case {
    ShearingBox box;
    double height;
    std::size_t count;
  };
  const Case cases[] = {{{4.0, 4.0, 1.5, 0.0}, 4.0, 2},      {{3.0, 50.0, 1.5, 0.0}, 6.0, 12},
                        {{60.0, 3.0, 1.5, 0.0}, 6.0, 12},    {{12.0, 10.0, 1.5, 0.0}, 10.0, 40},
                        {{400.0, 20.0, 1.5, 0.0}, 8.0, 120}, {{20.0, 400.0, 1.5, 0.0}, 8.0, 120},
                        {{20.0, 24.0, 1.5, 0.0}, 300.0, 120}};
  for (const Case& c : cases)
    for (const double part : {0.0, 0.3, 0.5}) {
      ClumpedState state = random_state(c.count, 10, c.box, c.height);
      state.offset = part * c.box.size_y;
      const double error = rms_error(by_fft(state, {3.0, 3.0}), exact_pair_by_pair(state, 1e-10));
      MESSAGE(c.box.size_x << " x " << c.box.size_y << " x " << c.height << " m, offset " << part << ": " << error);
      CHECK(error < 3e-3);
    }
  for (const std::size_t count : {0u, 1u, 2u})
    for (const Vec3& a : by_fft(clumped_state(count, 1), {3.0, 2.5}))
      CHECK(a.allFinite());
}

TEST_CASE("a lone particle feels nothing; a distant particle and the layer attract each other") {
  ClumpedState state = clumped_state(150, 11);
  state.positions[17] = Vec3(3.0, 2.0, 1500.0);
  const std::vector<Vec3> a = by_fft(state, {3.0, 2.5}), b = exact_pair_by_pair(state, 1e-10);
  const double error = rms_error(a, b), stray = (a[17] - b[17]).norm() / b[17].norm();
  MESSAGE("error of all: " << error << ", of the stray one: " << stray);
  CHECK(error < 2e-3);
  CHECK(stray < 2e-3);
  ClumpedState alone = state;
  alone.positions.resize(1);
  alone.masses.resize(1);
  alone.ids.resize(1);
  CHECK(by_fft(alone, {3.0, 2.5})[0].norm() == 0.0);
}

TEST_CASE("radii that span three decades cost no accuracy") {
  const ClumpedState state = clumped_state(3000, 12, 1000.0);
  const double error = error_of(state, {4.0, 2.25});
  MESSAGE("radii 1:1000, 4 m and 2.25: " << error);
  CHECK(error < 4e-3); // small particles are closer to each other than the mesh is fine
}

TEST_CASE("bodies at equal positions give finite accelerations") {
  ClumpedState state = clumped_state(200, 13);
  for (std::size_t k = 0; k < 150; ++k)
    state.positions[k] = state.positions[150] + Vec3(k % 3 == 1 ? 1e-9 : 0.0, k % 3 == 2 ? 1e-120 : 0.0, 0.0);
  for (const Vec3& a : by_fft(state, {4.0, 2.25}))
    CHECK(a.allFinite());
}

} // namespace fft_test
