// A clumped patch for tests of solvers: three quarters of the particles in trailing elongated clumps like self-gravity
// wakes, the rest a thin background, and no two spheres overlap (a buried pair would dominate every rms).
#pragma once

#include "lattice.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/gravity/solver.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace keeler_test {

using namespace keeler;
using namespace keeler::gravity;

struct ClumpedState {
  std::vector<Vec3> positions;
  std::vector<double> masses;
  std::vector<double> radii;
  std::vector<std::uint64_t> ids;
  ShearingBox box;
  double offset = 0.0;

  GravityProblem problem() const { return {positions, masses, ids, box, offset, newton_g(1.3175e-4)}; }
};

// Cells as wide as the largest sphere: spheres that overlap a new one are in its cell or a neighbouring one.
class OverlapGrid {
public:
  OverlapGrid(const ShearingBox& box, double width)
      : box_(box), nx_(static_cast<int>(box.size_x / width)), ny_(static_cast<int>(box.size_y / width)),
        columns_(static_cast<std::size_t>(nx_) * ny_) {}

  bool free(const Vec3& p, double radius, const ClumpedState& state) const {
    const auto [i, j] = column(p);
    for (int a = std::max(0, i - 1); a <= std::min(nx_ - 1, i + 1); ++a)
      for (int b = std::max(0, j - 1); b <= std::min(ny_ - 1, j + 1); ++b)
        for (const std::size_t k : columns_[static_cast<std::size_t>(a) * ny_ + b])
          if ((state.positions[k] - p).norm() < radius + state.radii[k])
            return false;
    return true;
  }

  void add(const Vec3& p, std::size_t k) {
    const auto [i, j] = column(p);
    columns_[static_cast<std::size_t>(i) * ny_ + j].push_back(k);
  }

private:
  std::pair<int, int> column(const Vec3& p) const {
    return {std::min(nx_ - 1, static_cast<int>((p.x() / box_.size_x + 0.5) * nx_)),
            std::min(ny_ - 1, static_cast<int>((p.y() / box_.size_y + 0.5) * ny_))};
  }

  ShearingBox box_;
  int nx_, ny_;
  std::vector<std::vector<std::size_t>> columns_;
};

// Returns a random point of a square in the plane.
inline Vec3 place_evenly(RandomStream& random, double side) {
  Vec3 p = Vec3::Zero();
  p.x() = (random.uniform() - 0.5) * side;
  p.y() = (random.uniform() - 0.5) * side;
  return p;
}

/// Returns a patch of optical depth about 0.6 for spheres of 1 m; spheres may overlap across the edge. Radii are
/// uniform in their logarithm between 1 m / size_range and 1 m.
inline ClumpedState clumped_state(std::size_t count, std::uint64_t seed, double size_range = 1.0) {
  constexpr double pitch = 20.0 / 180.0 * pi, length = 25.0, width = 5.0, height = 2.5; // m
  const double side = std::sqrt(static_cast<double>(std::max<std::size_t>(count, 10)) * pi / 0.6);
  ClumpedState state;
  state.box = {side, 0.9 * side, 1.5, 0.0};
  state.offset = 0.37 * state.box.size_y;
  const std::size_t clumps = std::max<std::size_t>(1, count / 300);
  OverlapGrid grid(state.box, 2.0);
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(seed, RandomPurpose::position, k);
    const double radius = std::pow(size_range, -random.uniform());
    Vec3 p;
    do {
      if (k % 4 == 0) {
        p = place_evenly(random, side);
        p.z() = 3.0 * random.normal();
      } else {
        RandomStream clump(seed, RandomPurpose::relaxation, k % clumps);
        const double along = length * random.normal(), across = width * random.normal();
        p = place_evenly(clump, side) + Vec3(across * std::cos(pitch) - along * std::sin(pitch),
                                             across * std::sin(pitch) + along * std::cos(pitch), 0.0);
        p.z() = height * random.normal();
      }
      p = into_cell(state.box, state.offset, p);
    } while (!grid.free(p, radius, state));
    grid.add(p, k);
    state.positions.push_back(p);
    state.radii.push_back(radius);
    state.masses.push_back(600.0 * 4.0 / 3.0 * pi * radius * radius * radius);
    state.ids.push_back(7 * k + 3);
  }
  return state;
}

inline std::vector<Vec3> accelerations(GravitySolver& solver, const GravityProblem& problem) {
  std::vector<Vec3> result(problem.positions.size(), Vec3::Constant(1e300));
  solver.accelerate(problem, result);
  return result;
}

/// Returns the exact periodic force, pair by pair, by Ewald's sums to that tolerance.
inline std::vector<Vec3> exact_pair_by_pair(const ClumpedState& state, double tolerance = 1e-15) {
  const GravityProblem problem = state.problem();
  const Lattice lattice(state.box, state.offset, tolerance);
  std::vector<Vec3> result(state.positions.size(), Vec3::Zero());
  parallel_for(
      result.size(),
      [&](std::size_t k) {
        for (std::size_t j = 0; j < result.size(); ++j)
          if (j != k)
            result[k] +=
                problem.newton_g * state.masses[j] * lattice.acceleration(state.positions[k] - state.positions[j]);
      },
      1);
  return result;
}

/// Returns the root of Σ |a − b|² / Σ |b|².
inline double rms_error(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double error = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    error += (a[k] - b[k]).squaredNorm();
    whole += b[k].squaredNorm();
  }
  return std::sqrt(error / whole);
}

} // namespace keeler_test
