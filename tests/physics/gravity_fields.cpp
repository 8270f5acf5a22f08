// Fields that are known in closed form: a wave in the surface density, an even sheet, two spheres in contact; and what
// true periodicity means at the edges. Every solver that a scene can name is held to them.
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/solver.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace keeler;

namespace {

struct Candidate {
  std::string name;
  GravitySettings settings;
  double pair_error;  // of two spheres in contact
  double field_error; // of smooth fields, of 2π G Σ
  double net_force;   // |Σ m a| / Σ |m a|
};

std::vector<Candidate> candidates() {
  using enum GravitySettings::Solver;
  return {{"direct", {.solver = direct}, 1e-6, 2e-3, 1e-12},
          {"tree", {.solver = tree, .opening_angle = 0.5}, 1e-6, 2e-3, 1e-4},
          {"fft", {.solver = fft}, 2e-3, 2e-3, 1e-5}};
}

struct Bodies {
  ShearingBox box{80.0, 100.0, 1.5, 0.0};
  double offset = 0.0;
  std::vector<Vec3> positions;
  std::vector<double> masses;
  std::vector<std::uint64_t> ids;

  void add(const Vec3& position, double mass) {
    positions.push_back(position);
    masses.push_back(mass);
    ids.push_back(ids.size());
  }

  std::vector<Vec3> accelerations(const GravitySettings& settings) const {
    std::vector<Vec3> result(positions.size());
    make_gravity_solver(settings, masses, box.area())->accelerate({positions, masses, ids, box, offset, 1.0}, result);
    return result;
  }
};

// side × side bodies in the plane, evenly spaced on a lattice that leans with the shear and so closes across its edges;
// a wave with so many crests along x and y modulates their masses by half. Mean surface density 1.
struct Sheet : Bodies {
  double kx, ky;

  Sheet(int side, double part_of_offset, int crests_x, int crests_y) {
    offset = part_of_offset * box.size_y;
    const double folded = std::remainder(offset, box.size_y);
    ky = two_pi * crests_y / box.size_y;
    kx = two_pi * crests_x / box.size_x + ky * folded / box.size_x;
    const bool waves = crests_x != 0 || crests_y != 0;
    const double mass = box.area() / (side * side);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double x = ((i + 0.5) / side - 0.5) * box.size_x;
        const double y = ((j + 0.5) / side - 0.5) * box.size_y - x / box.size_x * folded;
        add({x, y, 0.0}, mass * (1.0 + (waves ? 0.5 * std::cos(kx * x + ky * y) : 0.0)));
      }
  }

  // Of the continuous sheet, G = 1.
  Vec3 exact(const Vec3& at) const {
    const double k = std::hypot(kx, ky), side = at.z() < 0.0 ? -1.0 : 1.0;
    if (k == 0.0)
      return {0.0, 0.0, -two_pi * side};
    const double wave = 0.5 * two_pi * std::exp(-k * std::fabs(at.z())), phase = kx * at.x() + ky * at.y();
    const double along = -wave * std::sin(phase) / k;
    return {along * kx, along * ky, -side * (two_pi + wave * std::cos(phase))};
  }
};

// Probes of hardly any mass two lattice spacings and more from the plane, where grains are smoothed to e^{−4π} of Σ.
double worst_error(Sheet sheet, const GravitySettings& settings) {
  const std::size_t first = sheet.positions.size();
  RandomStream random(5, RandomPurpose::position, 1);
  for (int k = 0; k < 60; ++k) {
    const double x = (random.uniform() - 0.5) * sheet.box.size_x;
    const double y = (random.uniform() - 0.5) * sheet.box.size_y;
    const double z = (k % 2 == 0 ? 1.0 : -1.0) * (3.0 + 8.0 * random.uniform());
    sheet.add({x, y, z}, 1e-12);
  }
  const std::vector<Vec3> a = sheet.accelerations(settings);
  double worst = 0.0;
  for (std::size_t k = first; k < a.size(); ++k)
    worst = std::max(worst, (a[k] - sheet.exact(sheet.positions[k])).norm() / two_pi);
  return worst;
}

// Spheres of 1 m scattered in a layer.
Bodies layer(std::size_t count, double part_of_offset) {
  Bodies bodies;
  bodies.offset = part_of_offset * bodies.box.size_y;
  for (std::uint64_t k = 0; k < count; ++k) {
    RandomStream random(9, RandomPurpose::position, k);
    const double x = (random.uniform() - 0.5) * bodies.box.size_x;
    const double y = (random.uniform() - 0.5) * bodies.box.size_y;
    bodies.add({x, y, 2.0 * random.normal()}, 1.0 + random.uniform());
  }
  return bodies;
}

} // namespace

TEST_CASE("a wave in the surface density pulls as 2 pi G Sigma_k e^{-k|z|}, and an even sheet by 2 pi G Sigma") {
  for (const Candidate& candidate : candidates())
    for (const double part : {0.0, 0.3, 0.5, 0.9})
      for (const auto& crests : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 2}, {-3, 2}}) {
        const double error = worst_error(Sheet(64, part, crests.first, crests.second), candidate.settings);
        INFO(candidate.name << ", offset " << part << " L_y, crests " << crests.first << ", " << crests.second);
        CHECK(error < candidate.field_error);
      }
}

TEST_CASE("two spheres in contact attract as Newton has it") {
  for (const Candidate& candidate : candidates())
    for (const Vec3& direction : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.48, 0.6, 0.64)})
      for (const Vec3& place : {Vec3(0.0, 0.0, 0.0), Vec3(39.5, 12.0, 1.0), Vec3(-3.3, 49.7, -2.0)}) {
        Bodies bodies;
        bodies.box = {8000.0, 10000.0, 1.5, 0.0}; // their images pull by 1e-7 of that
        bodies.offset = 1234.0;
        bodies.add(place, 3.0);
        bodies.add(place + 2.0 * direction, 5.0);
        const std::vector<Vec3> a = bodies.accelerations(candidate.settings);
        INFO(candidate.name);
        CHECK((a[0] - 5.0 / 4.0 * direction).norm() < candidate.pair_error * 5.0 / 4.0);
        CHECK((a[1] + 3.0 / 4.0 * direction).norm() < candidate.pair_error * 3.0 / 4.0);
      }
}

TEST_CASE("self-gravity moves no centre of mass") {
  for (const Candidate& candidate : candidates()) {
    const Bodies bodies = layer(5000, 0.37);
    const std::vector<Vec3> a = bodies.accelerations(candidate.settings);
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      sum += bodies.masses[k] * a[k];
      whole += bodies.masses[k] * a[k].norm();
    }
    INFO(candidate.name << ": " << sum.norm() / whole);
    CHECK(sum.norm() < candidate.net_force * whole);
  }
}

// Moving the whole patch across the edges must move the forces along and change nothing else.
TEST_CASE("no place in the box is an edge") {
  for (const double part : {0.0, 0.3, 0.5, 0.999999, 1.000001}) {
    const Bodies bodies = layer(3000, part);
    Bodies moved = bodies;
    for (Vec3& p : moved.positions)
      p += Vec3(0.31 * bodies.box.size_x, -0.42 * bodies.box.size_y, 0.0);
    GravitySettings exact{.solver = GravitySettings::Solver::direct};
    exact.images.rings = 3;
    const std::vector<Vec3> reference = bodies.accelerations(exact);
    for (const Candidate& candidate : candidates())
      for (const std::vector<Vec3>& a :
           {bodies.accelerations(candidate.settings), moved.accelerations(candidate.settings)}) {
        double in_plane = 0.0;
        Vec3 pull = Vec3::Zero();
        int near_edge = 0;
        for (std::size_t k = 0; k < a.size(); ++k) {
          in_plane += reference[k].head<2>().squaredNorm();
          if (bodies.positions[k].x() > 0.45 * bodies.box.size_x) {
            pull += a[k] - reference[k];
            ++near_edge;
          }
        }
        const double rms = std::sqrt(in_plane / static_cast<double>(a.size()));
        INFO(candidate.name << ", offset " << part << " L_y: " << pull.head<2>().norm() / near_edge / rms);
        CHECK(pull.head<2>().norm() / near_edge < 2e-3 * rms);
      }
  }
}

TEST_CASE("forces do not jump when the offset wraps") {
  for (const Candidate& candidate : candidates()) {
    const std::vector<Vec3> before = layer(3000, 1.0 - 1e-12).accelerations(candidate.settings);
    const std::vector<Vec3> after = layer(3000, 0.0).accelerations(candidate.settings);
    double change = 0.0, whole = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      change += (after[k] - before[k]).squaredNorm();
      whole += after[k].squaredNorm();
    }
    INFO(candidate.name << ": " << std::sqrt(change / whole));
    CHECK(change < 1e-12 * whole);
  }
}

TEST_CASE("seen from random origins, errors average out instead of adding up") {
  const Bodies bodies = layer(4000, 0.37);
  const std::vector<Vec3> exact = bodies.accelerations({.solver = GravitySettings::Solver::direct});
  for (const Candidate& candidate : candidates()) {
    if (candidate.settings.solver == GravitySettings::Solver::direct)
      continue;
    constexpr int origins = 25;
    std::vector<Vec3> mean(exact.size(), Vec3::Zero());
    double single = 0.0, averaged = 0.0;
    for (std::uint64_t o = 0; o < origins; ++o) {
      RandomStream random(3, RandomPurpose::gravity_origin, o);
      Bodies moved = bodies;
      const double x = random.uniform() * bodies.box.size_x, y = random.uniform() * bodies.box.size_y;
      for (Vec3& p : moved.positions)
        p -= Vec3(x, y, 0.0);
      const std::vector<Vec3> a = moved.accelerations(candidate.settings);
      for (std::size_t k = 0; k < a.size(); ++k) {
        single += (a[k] - exact[k]).squaredNorm() / origins;
        mean[k] += a[k] / origins;
      }
    }
    for (std::size_t k = 0; k < mean.size(); ++k)
      averaged += (mean[k] - exact[k]).squaredNorm();
    MESSAGE(candidate.name << ": errors of the mean over those of one, squared: " << averaged / single);
    // 1/25 if errors were independent; what is left of the mesh's should be the split's error, which depends on
    // distances alone and so heats nothing
    CHECK(averaged < (candidate.name == "fft" ? 0.5 : 0.2) * single);
  }
}
