#include "local.hpp"

#include "states.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <doctest/doctest.h>

namespace local_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const ShearingBox box{60.0, 40.0, 1.5, 0.0};

Patch moving(Patch patch, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.masses[k] = 1.0 + static_cast<double>(k % 3);
    patch.radii[k] = 0.5 + 0.2 * static_cast<double>(k % 5);
    for (const double speed : {3.0, 2.0, 1.0})
      patch.velocities[k][3 - static_cast<int>(speed)] += speed * random.normal();
  }
  return patch;
}

// Calls visit(j, distance vector) for every particle and image but i itself, by brute force.
template<class Visit> void for_all_others(const Patch& patch, std::size_t i, const Visit& visit) {
  for (std::size_t j = 0; j < patch.size(); ++j)
    for (int nx = -3; nx <= 3; ++nx)
      for (int ny = -5; ny <= 5; ++ny)
        if (i != j || nx != 0 || ny != 0)
          visit(j, patch.positions[j] + patch.box.displacement({nx, ny}, patch.offset) - patch.positions[i]);
}

} // namespace

TEST_CASE("local motion and crowding are those of all pairs and images") {
  for (const double offset : {0.0, 17.3}) {
    for (const double radius : {3.0, 8.0}) {
      Patch patch = moving(test::uniform(box, offset, 150, 1), 2);
      patch.positions[3] += box.displacement({1, 0}, offset); // outside the cell by its eccentricity
      patch.velocities[3].y() -= box.shear * box.size_x;
      double mass = 0.0, with_neighbours = 0.0, discs = 0.0, cuts = 0.0;
      Vec3 squares = Vec3::Zero();
      for (std::size_t i = 0; i < patch.size(); ++i) {
        std::vector<std::size_t> near = {i};
        double own_discs = 0.0, own_cuts = 0.0;
        for_all_others(patch, i, [&](std::size_t j, const Vec3& d) {
          if (d.norm() <= radius)
            near.push_back(j);
          if (std::hypot(d.x(), d.y()) <= radius) {
            own_discs += patch.radii[j] * patch.radii[j];
            own_cuts += std::max(0.0, std::pow(patch.radii[j], 2) - std::pow(patch.positions[j].z(), 2));
          }
        });
        const double m = patch.masses[i];
        mass += m;
        discs += m * own_discs / (radius * radius);
        cuts += m * own_cuts / (radius * radius);
        if (near.size() == 1)
          continue;
        double near_mass = 0.0, near_squares = 0.0;
        Vec3 mean = Vec3::Zero(), variance = Vec3::Zero();
        for (const std::size_t j : near) {
          near_mass += patch.masses[j];
          near_squares += patch.masses[j] * patch.masses[j];
          mean += patch.masses[j] * peculiar_velocity(patch, j);
        }
        for (const std::size_t j : near) {
          const Vec3 v = peculiar_velocity(patch, j) - mean / near_mass;
          variance += patch.masses[j] / near_mass * v.cwiseProduct(v);
        }
        with_neighbours += m;
        squares += m * variance / (1.0 - near_squares / (near_mass * near_mass));
      }
      const LocalMotion motion = local_motion(patch, radius);
      CHECK(motion.fraction == doctest::Approx(with_neighbours / mass).epsilon(1e-12));
      CHECK((motion.dispersion - Vec3((squares / with_neighbours).cwiseSqrt())).norm() < 1e-11);
      const Crowding crowd = crowding(patch, radius);
      CHECK(crowd.optical_depth == doctest::Approx(discs / mass).epsilon(1e-12));
      CHECK(crowd.filling == doctest::Approx(cuts / mass).epsilon(1e-12));
    }
  }
}

TEST_CASE("independent velocities give their dispersion, streams do not count") {
  const ShearingBox wide{240.0, 200.0, 1.5, 0.0};
  Patch patch = test::uniform(wide, 33.0, 20000, 1);
  RandomStream random(7, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double x = patch.positions[k].x();
    patch.velocities[k] += Vec3(random.normal() + 5.0 * std::sin(two_pi * x / 120.0), random.normal(), 0.0);
  }
  CHECK(velocity_dispersion(patch).x() > 3.0);
  const LocalMotion motion = local_motion(patch, 2.0);                // 2.5 neighbours on average
  CHECK(motion.dispersion.x() == doctest::Approx(1.0).epsilon(0.05)); // the stream changes by 0.3 over a radius
  CHECK(motion.dispersion.y() == doctest::Approx(1.0).epsilon(0.02));
  CHECK(motion.dispersion.z() == 0.0);
  CHECK(motion.fraction > 0.8);
}

TEST_CASE("particles at random see the mean density; crowded ones see their crowd") {
  const ShearingBox wide{240.0, 200.0, 1.5, 0.0};
  const Patch random = test::uniform(wide, 33.0, 9600, 1);
  CHECK(crowding(random, 6.0).optical_depth == doctest::Approx(optical_depth(random)).epsilon(0.01));
  CHECK(crowding(random, 6.0).filling == doctest::Approx(midplane_filling(random)).epsilon(0.01));
  CHECK(crowding(random, 6.0).thin_area < 1e-3);

  // Everything in a fifth of the area, in lanes of 24 m along the orbit.
  const auto lane = [](double x, double) { return x > -60.0 && x < -36.0 ? 1.0 : x > 60.0 && x < 84.0 ? 1.0 : 0.0; };
  const Crowding lanes = crowding(test::scattered(wide, 0.0, 9600, 1, lane), 2.0);
  CHECK(lanes.optical_depth == doctest::Approx(5.0 * optical_depth(random)).epsilon(0.06)); // less at the edges
  CHECK(lanes.thin_area == doctest::Approx(0.8).epsilon(0.03));
  CHECK(lanes.cell_x == doctest::Approx(2.0 * std::sqrt(pi)).epsilon(0.05));
}

TEST_CASE("one particle has no neighbours; the bits do not depend on the threads") {
  CHECK(local_motion(test::uniform(box, 0.0, 1, 1), 3.0).fraction == 0.0);
  CHECK(local_motion(test::uniform(box, 0.0, 1, 1), 3.0).dispersion == Vec3::Zero());
  const Patch patch = moving(test::uniform(box, 11.0, 3000, 1), 2);
  set_threads(1);
  const LocalMotion one = local_motion(patch, local_radius(patch));
  const Crowding crowd = crowding(patch, crowding_radius(patch));
  set_threads(2);
  CHECK(local_motion(patch, local_radius(patch)).dispersion == one.dispersion);
  CHECK(crowding(patch, crowding_radius(patch)).optical_depth == crowd.optical_depth);
}

} // namespace local_test
