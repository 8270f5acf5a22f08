// The particles of all ranks on each of them, for solvers that need all sources.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <cstdint>
#include <vector>

namespace keeler::gravity {

/// Copies of the particles of all ranks, 40 bytes each, in the order of the ranks.
class GatheredParticles {
public:
  /// Collective.
  explicit GatheredParticles(const GravityProblem& own)
      : problem_(own), positions_(own.ranks.gather_on_all(own.positions)), masses_(own.ranks.gather_on_all(own.masses)),
        ids_(own.ranks.gather_on_all(own.ids)) {
    const std::uint64_t count[] = {own.positions.size()};
    std::size_t first = 0;
    for (const std::uint64_t of_rank : own.ranks.gather_on_all(std::span<const std::uint64_t>(count))) {
      first_.push_back(first);
      first += of_rank;
    }
    first_.push_back(first);
    problem_.positions = positions_;
    problem_.masses = masses_;
    problem_.ids = ids_;
    problem_.ranks = {};
  }
  GatheredParticles(const GatheredParticles&) = delete;
  GatheredParticles& operator=(const GatheredParticles&) = delete;

  /// All particles, as one process has them. Valid while this object exists.
  const GravityProblem& problem() const { return problem_; }
  /// The index of the first particle of each rank; then the number of all particles.
  const std::vector<std::size_t>& first_of_rank() const { return first_; }

private:
  GravityProblem problem_;
  std::vector<Vec3> positions_;
  std::vector<double> masses_;
  std::vector<std::uint64_t> ids_;
  std::vector<std::size_t> first_;
};

} // namespace keeler::gravity
