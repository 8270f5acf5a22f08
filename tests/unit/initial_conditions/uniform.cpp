#include <keeler/initial_conditions/uniform.hpp>

#include "draws.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/particles/sizes.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace uniform_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

// Makes a square box for these radii, and a layer with this mid-plane filling factor if Gaussian: V / (√(2π) H A).
UniformRequest layer(std::vector<double> radii, double optical_depth, double filling, std::uint64_t seed) {
  UniformRequest request;
  double area = 0.0, volume = 0.0;
  for (const double r : radii) {
    area += pi * r * r / optical_depth;
    volume += 4.0 / 3.0 * pi * r * r * r;
  }
  request.box = {std::sqrt(area), std::sqrt(area), request.frequencies.shear(), 0.37 * std::sqrt(area)};
  request.radii = std::move(radii);
  request.dispersion_z = volume / area / (std::sqrt(two_pi) * filling);
  request.dispersion_x = request.dispersion_z / 0.65;
  request.seed = seed;
  return request;
}

UniformRequest equal_layer(double optical_depth, double filling, std::size_t count, std::uint64_t seed) {
  return layer(std::vector<double>(count, 1.0), optical_depth, filling, seed);
}

std::vector<double> power_law(double smallest, double largest, std::size_t count) {
  return draw_radii(particles::power_sizes(3.0, smallest, largest), count, 4);
}

// Brute force: the smallest gap over all pairs and images, in units of the smaller radius.
double min_room(const Patch& patch) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < patch.size(); ++i)
    for (std::size_t j = 0; j < patch.size(); ++j)
      for (int nx = -2; nx <= 2; ++nx)
        for (int ny = -3; ny <= 3; ++ny) {
          if (i == j)
            continue; // a box is never narrower than its particles
          const Vec3 d = patch.positions[i] - patch.positions[j] - patch.box.displacement({nx, ny}, patch.offset);
          const double smaller = std::min(patch.radii[i], patch.radii[j]);
          least = std::min(least, (d.norm() - patch.radii[i] - patch.radii[j]) / smaller);
        }
  return least;
}

double rms_height(const Patch& patch) {
  double sum = 0.0;
  for (const Vec3& place : patch.positions)
    sum += place.z() * place.z();
  return std::sqrt(sum / static_cast<double>(patch.size()));
}

// |Σ m a| / √(Σ (m a)²) for each component of the peculiar velocity, and for the heights
double largest_mean(const Patch& patch) {
  double largest = 0.0;
  const auto add = [&](const auto& value) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const double term = patch.masses[k] * value(k);
      sum += term;
      squares += term * term;
    }
    if (squares > 0.0)
      largest = std::max(largest, std::fabs(sum) / std::sqrt(squares));
  };
  const auto elements = [&](std::size_t k) {
    return elements_from({patch.positions[k], patch.velocities[k]}, patch.frequencies, Rotation());
  };
  add([&](std::size_t k) { return elements(k).e_cos; });
  add([&](std::size_t k) { return elements(k).e_sin; });
  add([&](std::size_t k) { return elements(k).i_cos; });
  add([&](std::size_t k) { return elements(k).i_sin; });
  return largest;
}

} // namespace

TEST_CASE("no overlaps, up to a mid-plane filling of 0.55, with the height and the dispersion asked for") {
  for (const double filling : {0.05, 0.2, 0.4, 0.55})
    for (const double optical_depth : {0.1, 0.5, 1.5}) {
      CAPTURE(filling);
      CAPTURE(optical_depth);
      const UniformRequest request = equal_layer(optical_depth, filling, 2000, 3);
      const Patch patch = uniform_patch(request);
      CHECK(cells::largest_overlap(patch).depth == 0.0);
      double x2 = 0.0, y2 = 0.0, z2 = 0.0;
      for (std::size_t k = 0; k < patch.size(); ++k) {
        const Vec3& v = patch.velocities[k];
        x2 += v.x() * v.x();
        y2 += std::pow(v.y() + 1.5 * patch.positions[k].x(), 2);
        z2 += v.z() * v.z();
      }
      // three standard errors of a standard deviation from 2000 draws: 3/√4000
      CHECK(std::sqrt(x2 / 2000) == doctest::Approx(request.dispersion_x).epsilon(0.048));
      CHECK(std::sqrt(y2 / 2000) == doctest::Approx(0.5 * request.dispersion_x).epsilon(0.048));
      CHECK(std::sqrt(z2 / 2000) == doctest::Approx(request.dispersion_z).epsilon(0.048));
      if (request.dispersion_z > 1.2) // thinner ones are monolayers, which must buckle
        CHECK(rms_height(patch) == doctest::Approx(request.dispersion_z).epsilon(0.09)); // 3σ and 4 % of thickening
    }
}

TEST_CASE("each pair is apart, by brute force, in boxes large and small") {
  std::vector<UniformRequest> requests = {equal_layer(0.5, 0.2, 300, 1), equal_layer(2.0, 0.55, 300, 2),
                                          layer(power_law(0.1, 3.0, 300), 0.7, 0.3, 3)};
  std::vector<double> crowd(120, 0.1); // one large body leaves only the corners and the space above it
  crowd.push_back(1.0);
  requests.push_back(layer(crowd, 1.0, 0.4, 4));
  requests.back().box = {2.02, 2.1, 1.5, 0.7};
  requests.push_back(equal_layer(1.0, 0.3, 3, 5)); // a box of a few particles, each seeing its partners' images
  requests.push_back(equal_layer(1.0, 0.3, 5, 6));
  requests.back().box = {2.001, 40.0, 1.5, 13.0};
  for (const UniformRequest& request : requests) {
    CAPTURE(request.seed);
    CHECK(min_room(uniform_patch(request)) > 1.9e-5);
  }
}

TEST_CASE("sizes over three and four decades are placed without overlap") {
  const Patch power = uniform_patch(layer(power_law(0.01, 10.0, test::draws(10000)), 0.6, 0.2, 4));
  CHECK(cells::largest_overlap(power).depth == 0.0);
  std::vector<double> table;
  for (int k = 0; k <= 40; ++k) // from 1 to 10⁻⁴, in increasing number
    table.insert(table.end(), test::draws(static_cast<std::uint64_t>(std::pow(10.0, 0.09 * k))),
                 std::pow(10.0, -0.1 * k));
  const Patch listed = uniform_patch(layer(table, 0.8, 0.2, 5));
  CHECK(cells::largest_overlap(listed).depth == 0.0);
}

TEST_CASE("a moonlet takes the middle of a layer that is as thin as without it") {
  std::vector<double> radii(3000, 1.0);
  radii.push_back(12.0);
  UniformRequest request = layer(radii, 0.5, 0.1, 6);
  request.dispersion_z = 1.3;
  request.dispersion_x = 2.0;
  const Patch patch = uniform_patch(request);
  CHECK(cells::largest_overlap(patch).depth == 0.0);
  CHECK(std::fabs(patch.positions.back().z()) < 0.1);
  const Vec3 shear(0.0, -1.5 * patch.positions.back().x(), 0.0);
  CHECK((patch.velocities.back() - shear).norm() < 0.3);
  double squares = 0.0;
  for (std::size_t k = 0; k < 3000; ++k)
    squares += patch.positions[k].z() * patch.positions[k].z() / 3000.0;
  CHECK(std::sqrt(squares) == doctest::Approx(1.3).epsilon(0.1));
}

TEST_CASE("draws have no mean eccentricity vector, inclination vector or momentum") {
  for (const UniformRequest& request :
       {equal_layer(1.0, 0.4, 3000, 7), layer(power_law(0.1, 3.0, 3000), 0.5, 0.2, 8), equal_layer(0.1, 0.1, 2, 9)})
    CHECK(largest_mean(uniform_patch(request)) < 1e-11); // roundings of the shear and of the radial positions
}

TEST_CASE("one particle rests on its circle in the mid-plane, and none make an empty patch") {
  UniformRequest request = equal_layer(0.3, 0.2, 1, 1);
  const Patch one = uniform_patch(request);
  CHECK(std::fabs(one.positions[0].z()) < 1e-15);
  CHECK(std::fabs(one.velocities[0].x()) < 1e-15);
  request.radii.clear();
  CHECK(uniform_patch(request).size() == 0);
}

TEST_CASE("the same state for the same seed, whatever the threads") {
  const UniformRequest request = layer(power_law(0.2, 2.0, 4000), 0.8, 0.3, 9);
  set_threads(1);
  const Patch one = uniform_patch(request);
  set_threads(3);
  const Patch three = uniform_patch(request);
  set_threads(1);
  CHECK(one.positions == three.positions);
  CHECK(one.velocities == three.velocities);
  UniformRequest other = request;
  other.seed = 10;
  CHECK(uniform_patch(other).positions != one.positions);
}

TEST_CASE("progress rises to the end, and a stop is obeyed at the next sweep") {
  const UniformRequest request = layer(power_law(0.2, 2.0, 1000), 1.0, 0.4, 3);
  std::atomic<bool> stop = false;
  std::vector<double> fractions;
  const auto note = [&](const StartProgress& p) { fractions.push_back(p.fraction); };
  const Interruptible by_stop(stop);
  CHECK(uniform_patch(request, note).size() == 1000);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.back() == 1.0);
  int sweeps = 0;
  const auto stop_at_third = [&](const StartProgress&) { stop = ++sweeps == 3; };
  CHECK_THROWS_AS(uniform_patch(request, stop_at_third), Interrupted);
  CHECK(sweeps == 3);
  CHECK_THROWS_AS(uniform_patch(request), Interrupted); // before anything was done
}

TEST_CASE("a request that no packing can meet is refused in words") {
  UniformRequest request = equal_layer(1.2, 0.4, test::draws(300), 1);
  request.dispersion_z = 0.0; // a monolayer cannot hold τ = 1.2
  CHECK_THROWS_AS(uniform_patch(request), UsageError);
}

} // namespace uniform_test
