#include "states.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace states_test {

using namespace keeler;
using namespace keeler::bench;

namespace {

// Rounding of spheres in contact after a translation by 1000 m and back: positions have units of 1e-13 m.
constexpr double rounding = 1e-12;

BenchState state_of(BenchSizes sizes, std::size_t count, double optical_depth) {
  DriftBenchSettings settings;
  settings.sizes = sizes;
  settings.count = count;
  settings.optical_depth = optical_depth;
  PhaseProgress silent({});
  return bench_state(settings, silent);
}

} // namespace

TEST_CASE("a large state is made of tiles") {
  const Patch patch = state_of(BenchSizes::equal, 100050, 0.05).patch; // 2 × 2
  CHECK(patch.size() == 100052);
  CHECK(diagnostics::optical_depth(patch) == doctest::Approx(0.05).epsilon(1e-9));
  CHECK(cells::largest_overlap(patch).depth < rounding);
}

TEST_CASE("a moonlet replaces the particles that it touches") {
  const Patch before = state_of(BenchSizes::equal, 1000, 0.5).patch;
  const Patch after = with_moonlet(before, 10.0);
  CHECK(cells::largest_overlap(after).depth < rounding);
  CHECK(after.radii.back() == 10.0);
  CHECK(after.masses.back() == doctest::Approx(1000.0 * after.masses.front()).epsilon(1e-12));
  CHECK(std::find(after.ids.begin(), after.ids.end() - 1, after.ids.back()) == after.ids.end() - 1);
  // its cross-section and a margin: between (R − H)² and (R + 3r)² of τ/r², where the layer is H = 2 r high
  CHECK(before.size() - after.size() > 30);
  CHECK(before.size() - after.size() < 85);
}

TEST_CASE("sizes of a bench") {
  SUBCASE("a power law") {
    const Patch patch = state_of(BenchSizes::power, 300, 0.1).patch;
    CHECK(patch.size() == 300);
    CHECK(*std::min_element(patch.radii.begin(), patch.radii.end()) < 1.01);
    CHECK(*std::max_element(patch.radii.begin(), patch.radii.end()) > 17.0);
    // ⟨r²⟩ of so small a sample depends on its largest particle: 10 % at 50 m, 30 % at 90 m
    CHECK(diagnostics::optical_depth(patch) == doctest::Approx(0.1).epsilon(0.3));
    CHECK(cells::largest_overlap(patch).depth < rounding);
  }
  SUBCASE("a moonlet") {
    const Patch patch = state_of(BenchSizes::moonlet, 400, 0.02).patch;
    CHECK(patch.radii.back() == 100.0);
    CHECK(static_cast<double>(patch.size()) == doctest::Approx(400.0).epsilon(0.1)); // it displaces 200 ± 14
    CHECK(cells::largest_overlap(patch).depth < rounding);
    CHECK_THROWS_AS(state_of(BenchSizes::moonlet, 1000, 5.0), UsageError);
  }
}

} // namespace states_test
