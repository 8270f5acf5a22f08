#include <keeler/diagnostics/force_error.hpp>

#include <keeler/core/random.hpp>
#include <keeler/gravity/images.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace force_error_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

constexpr double rounding = 1e-12;

// Particles anywhere in a sheared box, some outside of the cell.
Patch scattered(std::size_t count) {
  Patch patch;
  patch.box = {100.0, 80.0, 1.5, 0.0};
  patch.offset = 30.0;
  patch.orbital_frequency = 1e-4;
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(7, RandomPurpose::position, k);
    patch.positions.push_back({110.0 * (random.uniform() - 0.5), 80.0 * (random.uniform() - 0.5), random.normal()});
    patch.masses.push_back(1.0 + random.uniform());
    patch.ids.push_back(k);
  }
  return patch;
}

} // namespace

TEST_CASE("a sample of forces holds different particles, and those near each edge") {
  const Patch patch = scattered(5000);
  const gravity::GravityProblem problem = gravity_problem(patch);
  const ForceSample sample = draw_force_sample(problem, 1000, 50, 3.0);
  CHECK(sample.uniform == 1000);
  CHECK(sample.edges == std::array<std::size_t, 4>{50, 50, 50, 50});
  REQUIRE(sample.targets.size() == 1200);
  CHECK(std::set<std::size_t>(sample.targets.begin(), sample.targets.begin() + 1000).size() == 1000);
  double mean = 0.0;
  for (std::size_t k = 0; k < 1000; ++k)
    mean += static_cast<double>(sample.targets[k]) / 1000.0;
  CHECK(mean == doctest::Approx(2500.0).epsilon(0.06)); // 5000 / √(12 · 1000) = 46: within three deviations
  for (std::size_t k = 1000; k < 1200; ++k) {
    const Vec3 p = gravity::into_cell(patch.box, patch.offset, patch.positions[sample.targets[k]]);
    const std::size_t edge = (k - 1000) / 50;
    const double depth[] = {p.x() + 50.0, 50.0 - p.x(), p.y() + 40.0, 40.0 - p.y()};
    CHECK(depth[edge] < 3.0);
    CHECK(depth[edge] > -rounding);
  }
  CHECK(draw_force_sample(problem, 1000, 50, 3.0).targets == sample.targets);
}

TEST_CASE("a sample has the same particles in any order of memory") {
  const Patch patch = scattered(700);
  Patch reversed = patch;
  std::reverse(reversed.positions.begin(), reversed.positions.end());
  std::reverse(reversed.masses.begin(), reversed.masses.end());
  std::reverse(reversed.ids.begin(), reversed.ids.end());
  const ForceSample sample = draw_force_sample(gravity_problem(patch), 100, 20, 3.0);
  const ForceSample other = draw_force_sample(gravity_problem(reversed), 100, 20, 3.0);
  REQUIRE(other.targets.size() == sample.targets.size());
  for (std::size_t k = 0; k < sample.targets.size(); ++k)
    CHECK(reversed.ids[other.targets[k]] == patch.ids[sample.targets[k]]);
}

TEST_CASE("a sample of more than there are is all of them") {
  const Patch patch = scattered(30);
  const ForceSample sample = draw_force_sample(gravity_problem(patch), 100, 100, 0.0);
  CHECK(std::set<std::size_t>(sample.targets.begin(), sample.targets.end()).size() == 30);
  CHECK(sample.uniform == 30);
  CHECK(sample.edges == std::array<std::size_t, 4>{});
}

TEST_CASE("errors of forces") {
  // Forces of size 5 in the plane and 12 across, known exactly; each error is one of these.
  const std::size_t count = 2000;
  const std::vector<Vec3> exact(count, Vec3(3.0, 4.0, 12.0));
  ForceSample sample{std::vector<std::size_t>(count), 1000, {250, 250, 250, 250}};
  std::iota(sample.targets.begin(), sample.targets.end(), std::size_t{0});
  std::vector<Vec3> wrong = exact;
  for (std::size_t k = 0; k < 1000; ++k)
    wrong[k] += Vec3(0.1, -0.2, k % 2 ? 0.2 : -0.2);
  for (std::size_t k = 1000; k < 1500; ++k) // at the edges in x alternating errors, with zero mean
    wrong[k].x() += k % 2 ? 0.5 : -0.5;
  for (std::size_t k = 1750; k < 2000; ++k) // at the last edge always the same
    wrong[k] += Vec3(0.3, 0.4, 1.0);
  const ForceErrors e = force_errors(sample, exact, wrong);
  CHECK(e.rms == doctest::Approx(0.3 / 13.0).epsilon(rounding));
  CHECK(e.p999 == doctest::Approx(0.3 / 13.0).epsilon(rounding));
  CHECK(e.component_rms[0] == doctest::Approx(0.1 / 13.0).epsilon(rounding));
  CHECK(e.component_rms[1] == doctest::Approx(0.2 / 13.0).epsilon(rounding));
  CHECK(e.component_rms[2] == doctest::Approx(0.2 / 13.0).epsilon(rounding));
  CHECK(e.edge_rms == doctest::Approx(std::sqrt((0.25 * 500 + 1.25 * 250) / 1000) / 13.0).epsilon(rounding));
  CHECK(e.edge_pull == doctest::Approx(0.5 / 5.0).epsilon(rounding));

  // One in a thousand may be worse than the percentile says, two not.
  wrong[17] = exact[17] + Vec3(0.0, 0.0, 7.0);
  CHECK(force_errors(sample, exact, wrong).p999 == doctest::Approx(0.3 / 13.0).epsilon(rounding));
  wrong[18] = exact[18] + Vec3(0.0, 0.0, 6.0);
  CHECK(force_errors(sample, exact, wrong).p999 == doctest::Approx(6.0 / 13.0).epsilon(rounding));
}

TEST_CASE("the net force is that of all particles") {
  const std::vector<double> masses = {1.0, 2.0};
  CHECK(net_force(masses, std::vector<Vec3>{{2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}) < rounding);
  CHECK(net_force(masses, std::vector<Vec3>{{2.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}) ==
        doctest::Approx(std::sqrt(8.0) / 4.0).epsilon(rounding));
  CHECK(net_force(masses, std::vector<Vec3>(2, Vec3::Zero())) == 0.0);
}

} // namespace force_error_test
