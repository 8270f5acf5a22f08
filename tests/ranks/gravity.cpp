// Each solver on several ranks has the bits of one process, for any distribution of the particles.
#include <keeler/gravity/fft.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>

#include "launched.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

using namespace keeler;
using keeler_test::launched;

namespace {

struct Sample {
  std::string name;
  ShearingBox box;
  std::vector<Vec3> positions;
  std::vector<double> masses;
  std::vector<std::uint64_t> ids;

  gravity::GravityProblem problem(double offset) const { return {positions, masses, ids, box, offset, 2.7e-3, {}}; }
};

// Makes particles with a power law of masses over three decades; position(random) is in units of the box along x and y,
// and in metres along z.
template<class Position>
Sample sample(const char* name, std::size_t count, double size_x, double size_y, const Position& position) {
  Sample made{name, {size_x, size_y, 1.5, 0.0}, {}, {}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(11, RandomPurpose::position, k);
    const Vec3 p = position(random);
    made.positions.emplace_back(p.x() * size_x, p.y() * size_y, p.z());
    made.masses.push_back(1e3 * std::pow(random.uniform() + 1e-3, -1.0));
    made.ids.push_back(5 * k + 2);
  }
  return made;
}

Vec3 anywhere(RandomStream& random) {
  const double x = random.uniform() - 0.5, y = random.uniform() - 0.5;
  return {x, y, random.normal()};
}

std::vector<Sample> samples() {
  const auto clumped = [](RandomStream& random) {
    const double clump = std::floor(5.0 * random.uniform());
    const double x = 0.01 * random.normal() + 0.2 * clump - 0.5, y = 0.05 * random.normal() - 0.1 * clump;
    return Vec3(x, y, 0.5 * random.normal());
  };
  const auto at_one_side = [](RandomStream& random) {
    const Vec3 p = anywhere(random);
    return Vec3(random.uniform() < 0.01 ? p.x() : 0.05 * p.x() - 0.45, p.y(), p.z());
  };
  const auto at_both_edges = [](RandomStream& random) {
    const Vec3 p = anywhere(random);
    return Vec3(0.06 * p.x() + 0.5, p.y(), p.z());
  };
  const auto far_outside = [](RandomStream& random) {
    const Vec3 p = anywhere(random);
    return Vec3(p.x() + std::round(3.0 * random.normal()), p.y() + std::round(3.0 * random.normal()), p.z());
  };
  const auto in_a_plane = [](RandomStream& random) {
    const Vec3 p = anywhere(random);
    return Vec3(p.x(), p.y(), 0.0);
  };
  return {
      sample("even, wide", 6000, 400.0, 60.0, anywhere),
      sample("even, waves in batches", 16000, 300.0, 300.0, anywhere),
      sample("even, long", 3000, 50.0, 240.0, anywhere),
      sample("clumped", 4000, 160.0, 100.0, clumped),
      sample("at one side", 3000, 300.0, 50.0, at_one_side),
      sample("at both edges", 2000, 300.0, 50.0, at_both_edges),
      sample("far outside", 1500, 150.0, 60.0, far_outside),
      sample("in a plane", 1500, 150.0, 60.0, in_a_plane),
      sample("a few cells", 60, 9.0, 8.0, anywhere),
      sample("few in a large box", 5, 300.0, 300.0, anywhere),
      sample("one", 1, 40.0, 30.0, anywhere),
  };
}

enum class Distribution { by_id, by_position, to_last };

// Returns the owner of a particle; some ranks may own nothing.
std::size_t owner(Distribution distribution, const Sample& state, std::size_t k, std::size_t ranks) {
  if (distribution == Distribution::by_id)
    return (state.ids[k] * 0x9e3779b97f4a7c15u >> 33) % ranks;
  const double x = state.positions[k].x() / state.box.size_x;
  const auto slab = static_cast<std::size_t>((x - std::floor(x)) * static_cast<double>(ranks));
  return distribution == Distribution::by_position ? std::min(slab, ranks - 1) : ranks - 1;
}

struct Part {
  Sample state;
  std::vector<std::size_t> indices; // in the whole sample
};

Part own_part(const Sample& whole, Distribution distribution) {
  Part own{{whole.name, whole.box, {}, {}, {}}, {}};
  for (std::size_t k = whole.ids.size(); k-- > 0;)
    if (owner(distribution, whole, k, launched().size()) == launched().rank()) {
      own.state.positions.push_back(whole.positions[k]);
      own.state.masses.push_back(whole.masses[k]);
      own.state.ids.push_back(whole.ids[k]);
      own.indices.push_back(k);
    }
  return own;
}

std::vector<Vec3> solve(gravity::GravitySolver& solver, gravity::GravityProblem problem, const Communicator& ranks) {
  std::vector<Vec3> accelerations(problem.positions.size(), Vec3::Constant(1e300));
  problem.ranks = ranks;
  solver.accelerate(problem, accelerations);
  return accelerations;
}

// Returns the number of own accelerations whose bits differ from those of one process.
std::size_t differing(const std::vector<Vec3>& whole, const Part& own, const std::vector<Vec3>& accelerations) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < accelerations.size(); ++k)
    count += std::memcmp(&whole[own.indices[k]], &accelerations[k], sizeof(Vec3)) != 0;
  return count;
}

} // namespace

TEST_CASE("accelerations of fft and mesh on many ranks have the bits of one process") {
  for (const bool short_range : {true, false})
    for (const double cut : {2.5, 7.0}) {
      if (!short_range && cut > 3.0)
        continue;
      const gravity::FftSettings settings{1.4, cut, short_range};
      gravity::FftSolver distributed(settings, choose_instruction_set()); // reuses its memory for all states
      for (const Sample& whole : samples()) {
        gravity::FftSolver alone(settings, choose_instruction_set());
        for (const double fraction : {0.0, 0.37, 0.499999, 0.83}) {
          const double offset = fraction * whole.box.size_y;
          const std::vector<Vec3> expected = solve(alone, whole.problem(offset), {});
          for (const Distribution distribution :
               {Distribution::by_id, Distribution::by_position, Distribution::to_last}) {
            CAPTURE(whole.name);
            CAPTURE(short_range);
            CAPTURE(cut);
            CAPTURE(fraction);
            CAPTURE(static_cast<int>(distribution));
            const Part own = own_part(whole, distribution);
            CHECK(differing(expected, own, solve(distributed, own.state.problem(offset), launched())) == 0);
          }
        }
      }
    }
}

TEST_CASE("energy and stress on many ranks have the bits of one process, on each of them") {
  for (const bool short_range : {true, false}) {
    const gravity::FftSettings settings{1.4, 2.5, short_range};
    gravity::FftSolver distributed(settings, choose_instruction_set());
    for (const Sample& whole : samples()) {
      gravity::FftSolver alone(settings, choose_instruction_set());
      for (const double fraction : {0.0, 0.37, 0.83}) {
        const gravity::GravityEnergy expected = alone.energy(whole.problem(fraction * whole.box.size_y));
        for (const Distribution distribution :
             {Distribution::by_id, Distribution::by_position, Distribution::to_last}) {
          CAPTURE(whole.name);
          CAPTURE(short_range);
          CAPTURE(fraction);
          const Part own = own_part(whole, distribution);
          gravity::GravityProblem problem = own.state.problem(fraction * whole.box.size_y);
          problem.ranks = launched();
          const gravity::GravityEnergy found = distributed.energy(problem);
          CHECK(found.potential == expected.potential);
          CHECK(found.stress == expected.stress);
        }
      }
    }
  }
}

TEST_CASE("accelerations of other solvers on many ranks have the bits of one process") {
  using Solver = GravitySettings::Solver;
  struct Method {
    Solver solver;
    double opening_angle;
    gravity::ImageSettings images;
    std::size_t max_particles;
  };
  for (const Method& method : {Method{Solver::tree, 0.7, {}, 6000}, Method{Solver::tree, 0.3, {2, false}, 3000},
                               Method{Solver::direct, 0.0, {}, 1500}, Method{Solver::axisymmetric, 0.0, {}, 6000}})
    for (const Sample& whole : samples()) {
      if (whole.ids.size() > method.max_particles)
        continue;
      GravitySettings settings;
      settings.solver = method.solver;
      settings.opening_angle = method.opening_angle;
      settings.images = method.images;
      settings.shortest_wavelength = whole.box.size_x / 7.0;
      const auto alone = make_gravity_solver(settings, whole.masses, whole.box.area());
      const auto distributed = make_gravity_solver(settings, whole.masses, whole.box.area());
      for (const double fraction : {0.0, 0.37}) {
        const double offset = fraction * whole.box.size_y;
        const std::vector<Vec3> expected = solve(*alone, whole.problem(offset), {});
        for (const Distribution distribution :
             {Distribution::by_id, Distribution::by_position, Distribution::to_last}) {
          CAPTURE(whole.name);
          CAPTURE(static_cast<int>(method.solver));
          CAPTURE(method.opening_angle);
          CAPTURE(fraction);
          CAPTURE(static_cast<int>(distribution));
          const Part own = own_part(whole, distribution);
          CHECK(differing(expected, own, solve(*distributed, own.state.problem(offset), launched())) == 0);
          if (method.solver == Solver::axisymmetric) {
            gravity::GravityProblem problem = own.state.problem(offset);
            problem.ranks = launched();
            CHECK(dynamic_cast<gravity::EnergyMeter&>(*distributed).energy(problem).potential ==
                  dynamic_cast<gravity::EnergyMeter&>(*alone).energy(whole.problem(offset)).potential);
          }
        }
      }
    }
}

TEST_CASE("a position that is not finite on one rank is an error on all") {
  const Sample whole = samples().back();
  Part own = own_part(whole, Distribution::to_last);
  gravity::FftSolver solver({1.4, 2.5, true}, choose_instruction_set());
  for (const double nowhere : {std::numeric_limits<double>::quiet_NaN(), 1e30}) {
    if (std::isfinite(nowhere) && !launched().distributed())
      continue; // one process treats it as a position at the edge
    for (Vec3& position : own.state.positions)
      position.x() = nowhere;
    CHECK_THROWS_AS(solve(solver, own.state.problem(0.0), launched()), Error);
  }
}

TEST_CASE("no particles at all are no error") {
  using Solver = GravitySettings::Solver;
  const Sample none{"none", {40.0, 30.0, 1.5, 0.0}, {}, {}, {}};
  for (const Solver method : {Solver::fft, Solver::tree, Solver::direct, Solver::axisymmetric}) {
    GravitySettings settings;
    settings.solver = method;
    settings.shortest_wavelength = 10.0;
    const auto solver = make_gravity_solver(settings, none.masses, none.box.area());
    CHECK(solve(*solver, none.problem(0.0), launched()).empty());
  }
}
