// The mesh solver on many ranks, with the bits of one process: particles are sent to the ranks that need them
// (ghost_exchange.hpp), the spectrum is transposed between the transforms along y and x (spectrum_transpose.hpp), and
// accelerations return to the particles' owners. Each rank does the rest for its part alone (mesh_partition.hpp).
#include "fft_parts.hpp"

#include "ghost_exchange.hpp"
#include "mesh_partition.hpp"
#include "spectrum_transpose.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace keeler::gravity {
namespace {

// Returns the heights of the particles of all ranks. Collective.
Extent extent_of_all(const GravityProblem& problem) {
  Extent z{};
  problem.ranks.together([&] { z = extent_of(problem.positions); });
  return {problem.ranks.min(z.low), problem.ranks.max(z.high)};
}

// Returns the mean mass of the `count` particles of all ranks, kg; 1 if it is 0. Collective.
double mean_mass_of_all(const GravityProblem& problem, std::uint64_t count) {
  auto mass =
      exact_total<ExactSum>(problem.masses.size(), [&](ExactSum& sum, std::size_t k) { sum += problem.masses[k]; });
  problem.ranks.merge({&mass});
  const double total = mass.value();
  return total > 0.0 ? total / static_cast<double>(count) : 1.0;
}

// Returns the particles folded into the cell. Throws InvariantError on all ranks if one is too far away. Collective.
std::vector<FoldedParticle> fold(const GravityProblem& problem, double offset) {
  std::vector<FoldedParticle> folded;
  resize_scratch(folded, problem.positions.size());
  parallel_for(folded.size(), [&](std::size_t k) {
    const Vec3 p = into_cell(problem.box, offset, problem.positions[k]);
    folded[k] = {p.x(), p.y(), p.z(), problem.masses[k], problem.ids[k]};
  });
  const double max_x = largest_of(folded.size(), [&](std::size_t k) { return std::fabs(folded[k].x); });
  problem.ranks.together([&] {
    if (!(max_x <= 0.5 * (1.0 + edge_tolerance) * problem.box.size_x))
      throw InvariantError("a particle is too far away to be folded into the box; take a shorter time.step");
  });
  return folded;
}

std::vector<std::uint64_t> count_per_column(std::span<const FoldedParticle> particles, const Tiling& tiling,
                                            const TileFinder& find) {
  std::vector<std::uint64_t> counts(tiling.tile_columns(), 0);
  for (const FoldedParticle& particle : particles)
    ++counts[find.column(particle.x)];
  return counts;
}

} // namespace

// What lives for one solve: the mesh, its partition, and the two exchanges.
struct FftSolver::Parts::DistributedSolve {
  MeshShape shape;
  double offset_fraction; // of the box's length
  MeshPartition partition;
  GhostExchange ghosts;
  SpectrumTranspose transpose;

  const IndexRange& waves() const { return partition.own().waves; }
  std::size_t first_tile(const Tiling& tiling) const { return partition.own().assigned.begin * tiling.tile_rows(); }
  std::size_t tiles(const Tiling& tiling) const { return partition.own().assigned.size() * tiling.tile_rows(); }
};

// Chooses and partitions the mesh, and sorts the particles that this rank needs. Collective.
FftSolver::Parts::DistributedSolve FftSolver::Parts::begin_distributed(const GravityProblem& problem, double offset,
                                                                       bool with_neighbours) {
  const Communicator& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  assert(count > 0);
  const MeshShape shape = choose_mesh(problem.box, extent_of_all(problem), count);
  const Tiling tiling = tiling_for(shape, count);
  std::vector<FoldedParticle> folded = fold(problem, offset); // not needed once they are sorted
  const TileFinder find(tiling, problem.box);
  const std::vector<std::uint64_t> per_column = count_per_column(folded, tiling, find);
  MeshPartition partition(shape, tiling, problem.box, with_neighbours ? radius : 0.0, per_column, ranks);
  GhostExchange ghosts(folded, per_column, find, partition, ranks);
  sorted.sort(folded, problem.box, tiling, partition.own().needed, mean_mass_of_all(problem, count));
  SpectrumTranspose transpose(partition, shape);
  return {shape, offset / problem.box.size_y, std::move(partition), std::move(ghosts), std::move(transpose)};
}

// Spreads the masses on this rank's part of the mesh and transforms them along y. Returns all waves of this rank's
// columns, in the mesh's memory.
HalfSpectrum FftSolver::Parts::spread_distributed(const DistributedSolve& solve) {
  const MeshPart& own = solve.partition.own();
  const MeshShape& shape = solve.shape;
  mesh.reset(shape, own.stored);
  mesh.spread(sorted, own.spread, kernels);
  transform.prepare(shape, solve.offset_fraction, own.waves);
  waves.prepare(shape);

  HalfSpectrum by_columns(mesh, own.interpolated, transform.waves());
  transform.forward_y(mesh, by_columns);
  return by_columns;
}

// Turns the masses into the potential at this rank's particles. Collective.
void FftSolver::Parts::fill_mesh_distributed(const Communicator& ranks, const DistributedSolve& solve) {
  HalfSpectrum by_columns = spread_distributed(solve), by_waves;
  for (std::size_t batch = 0; batch < solve.transpose.batches(); ++batch) {
    solve.transpose.to_waves(batch, by_columns, by_waves, ranks);
    transform.change_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
      waves.apply(solve.shape, transform, m, kernels, from, to);
    });
    solve.transpose.to_columns(batch, by_waves, by_columns, ranks);
  }
  transform.backward_y(by_columns, mesh);
}

void FftSolver::Parts::accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const Communicator& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  const DistributedSolve solve = begin_distributed(problem, offset, settings.short_range);
  fill_mesh_distributed(ranks, solve);

  AlignedArray<Vec3> memory;
  memory.resize_at_least(sorted.count());
  const std::span<Vec3> computed(memory.data(), sorted.count());
  std::vector<Vec3> sums(solve.tiles(sorted.tiling()));
  const std::size_t first = solve.first_tile(sorted.tiling());
  parallel_for(
      sums.size(), [&](std::size_t k) { sums[k] = accelerate_tile(problem, offset, first + k, computed); }, 4);
  auto total = exact_total<ExactVec3>(sums.size(), [&](ExactVec3& all, std::size_t k) { all += sums[k]; });
  ranks.merge({&total.x, &total.y, &total.z});
  const Vec3 mean = total.value() / static_cast<double>(count); // subtracted as in FftSolver::accelerate()
  release();
  solve.ghosts.return_to_owners(computed, ranks, [&](std::size_t k, const Vec3& a) { accelerations[k] = a - mean; });
}

double FftSolver::Parts::mesh_potential_distributed(const GravityProblem& problem, double offset) {
  const DistributedSolve solve = begin_distributed(problem, offset, false);
  HalfSpectrum by_columns = spread_distributed(solve), by_waves;
  std::vector<double> sums(solve.waves().size());
  for (std::size_t batch = 0; batch < solve.transpose.batches(); ++batch) {
    solve.transpose.to_waves(batch, by_columns, by_waves, problem.ranks);
    transform.visit_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
      waves.apply(solve.shape, transform, m, kernels, from, to);
      sums[m - solve.waves().begin] = wave_potential(m, from, to);
    });
  }
  auto sum = exact_total<ExactSum>(sums.size(), [&](ExactSum& all, std::size_t k) { all += sums[k]; });
  const std::size_t tiles = solve.tiles(sorted.tiling()), first = solve.first_tile(sorted.tiling());
  ExactSum squares;
  if (tiles > 0)
    squares = squared_masses(sorted.first(first), sorted.end(first + tiles - 1));
  problem.ranks.merge({&sum, &squares});
  return sum.value() - 0.5 * squares.value() * split.potential()[0] / radius;
}

NearForces::Energy FftSolver::Parts::near_energy_distributed(const GravityProblem& problem, double offset) {
  const DistributedSolve solve = begin_distributed(problem, offset, true);
  NearSums sums = near_sums(problem.box, offset, solve.first_tile(sorted.tiling()), solve.tiles(sorted.tiling()));
  problem.ranks.merge({&sums.potential, &sums.stress});
  return {sums.potential.value(), sums.stress.value()};
}

} // namespace keeler::gravity
