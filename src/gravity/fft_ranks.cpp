// The mesh solver on many ranks, with the bits of one process (mesh_shares.hpp). Particles go to the ranks that need
// them, waves go over in between the two transforms, accelerations come back; all else is done by the owner alone.
#include "fft_parts.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

namespace keeler {
namespace {

Extent common_extent(const GravityProblem& problem) {
  Extent z{};
  problem.ranks.together([&] { z = extent_of(problem.positions); });
  return {problem.ranks.least(z.low), problem.ranks.largest(z.high)};
}

double common_mass_unit(const GravityProblem& problem, std::uint64_t count) {
  auto mass =
      exact_total<ExactSum>(problem.masses.size(), [&](ExactSum& sum, std::size_t k) { sum += problem.masses[k]; });
  problem.ranks.merge({&mass});
  const double whole = mass.value();
  return whole > 0.0 ? whole / static_cast<double>(count) : 1.0;
}

void put_inside(const GravityProblem& problem, double offset, std::vector<InsideParticle>& inside) {
  resize_scratch(inside, problem.positions.size());
  parallel_for(inside.size(), [&](std::size_t k) {
    const Vec3 p = into_cell(problem.box, offset, problem.positions[k]);
    inside[k] = {p.x(), p.y(), p.z(), problem.masses[k], problem.ids[k]};
  });
  const double farthest = largest_of(inside.size(), [&](std::size_t k) { return std::fabs(inside[k].x); });
  problem.ranks.together([&] {
    if (!(farthest <= 0.5 * (1.0 + loose_edge) * problem.box.size_x))
      throw InvariantError("a particle stands too far away to be put into the box; take a shorter time.step");
  });
}

std::vector<std::uint64_t> count_in_columns(std::span<const InsideParticle> particles, const Tiling& tiling,
                                            const TileFinder& find) {
  std::vector<std::uint64_t> counts(tiling.tile_columns(), 0);
  for (const InsideParticle& particle : particles)
    ++counts[find.column(particle.x)];
  return counts;
}

// Collective. The mesh's origin may wander against the ranks' particles. So shares are dealt out round the box from
// where most particles are in the share of the rank that has them already.
void deal_out(std::vector<MeshShare>& shares, std::span<const std::uint64_t> here, const Communicator& ranks) {
  std::vector<std::uint64_t> stay(shares.size(), 0); // by how far the shares are turned
  for (std::size_t turn = 0; turn < stay.size(); ++turn) {
    const IndexRange& own = shares[(ranks.rank() + turn) % shares.size()].own;
    const auto its = here.subspan(own.begin, own.size());
    stay[turn] = std::accumulate(its.begin(), its.end(), std::uint64_t{0});
  }
  ranks.sum(std::span(stay));
  std::rotate(shares.begin(), shares.begin() + (std::max_element(stay.begin(), stay.end()) - stay.begin()),
              shares.end());
}

// Collective: the share of each rank. `here` counts this one's particles in the columns of tiles.
std::vector<MeshShare> shares_of(const std::vector<std::uint64_t>& here, const MeshShape& shape, const Tiling& tiling,
                                 const ShearingBox& box, double reach, const Communicator& ranks) {
  std::vector<std::uint64_t> all = here;
  ranks.sum(std::span(all));
  std::vector<MeshShare> shares = share_mesh(shape, tiling, box, reach, all, ranks.size());
  deal_out(shares, here, ranks);
  return shares;
}

bool is_in(const IndexRange& range, std::size_t column) {
  return column >= range.begin && column < range.end;
}

// The particles that a rank must know, and the way home of what becomes of its own ones. Most stay where they are.
class Guests {
public:
  /// Collective: sends particles to all that must know them. The rank's own ones, so many in each column, become those
  /// that it must know.
  Guests(std::vector<InsideParticle>& particles, std::span<const std::uint64_t> counts, const TileFinder& find,
         std::span<const MeshShare> shares, const Tiling& tiling, const Communicator& ranks)
      : sent_(ranks.size()), owned_(ranks.size()) {
    const auto knowers = who_must_know(shares, tiling);
    const IndexRange& here = shares[ranks.rank()].own;
    std::vector<std::vector<InsideParticle>> parcels = room_for_parcels(counts, knowers, ranks);
    for (std::size_t rank = 0; rank < shares.size(); ++rank) {
      const auto its = counts.subspan(shares[rank].own.begin, shares[rank].own.size());
      sent_[rank].reserve(std::accumulate(its.begin(), its.end(), std::uint64_t{0}));
    }
    owned_[ranks.rank()].reserve(sent_[ranks.rank()].capacity());
    std::size_t stay = 0;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      const InsideParticle particle = particles[k];
      const std::size_t column = find.column(particle.x);
      for (const std::uint32_t rank : knowers[column]) {
        const bool owns = is_in(shares[rank].own, column);
        if (owns)
          sent_[rank].push_back(static_cast<std::uint32_t>(k));
        if (rank != ranks.rank()) {
          parcels[rank].push_back(particle);
          continue;
        }
        if (owns)
          owned_[rank].push_back(static_cast<std::uint32_t>(stay));
        particles[stay++] = particle;
      }
    }
    particles.resize(stay);
    parcels = ranks.exchange(parcels);
    std::size_t known = stay;
    for (const std::vector<InsideParticle>& some : parcels)
      known += some.size();
    if (particles.capacity() < known)
      particles.reserve(known + known / 16);
    for (std::size_t rank = 0; rank < parcels.size(); ++rank) {
      for (const InsideParticle& particle : parcels[rank]) {
        if (is_in(here, find.column(particle.x)))
          owned_[rank].push_back(static_cast<std::uint32_t>(particles.size()));
        particles.push_back(particle);
      }
      std::vector<InsideParticle>().swap(parcels[rank]);
    }
  }

  /// Collective: from values of all that it must know, in their order, that of each particle comes home from its owner
  /// in the mesh.
  template<class Take> void send_home(std::span<const Vec3> values, const Communicator& ranks, const Take& take) const {
    using Row = std::array<double, 3>;
    std::vector<std::vector<Row>> rows(ranks.size());
    for (std::size_t rank = 0; rank < rows.size(); ++rank)
      if (rank != ranks.rank()) {
        rows[rank].reserve(owned_[rank].size());
        for (const std::uint32_t k : owned_[rank])
          rows[rank].push_back({values[k].x(), values[k].y(), values[k].z()});
      }
    rows = ranks.exchange(rows);
    for (std::size_t i = 0; i < owned_[ranks.rank()].size(); ++i)
      take(sent_[ranks.rank()][i], values[owned_[ranks.rank()][i]]);
    for (std::size_t rank = 0; rank < rows.size(); ++rank) {
      assert(rank == ranks.rank() || rows[rank].size() == sent_[rank].size());
      for (std::size_t i = 0; i < rows[rank].size(); ++i)
        take(sent_[rank][i], Vec3(rows[rank][i][0], rows[rank][i][1], rows[rank][i][2]));
    }
  }

private:
  static std::vector<std::vector<InsideParticle>> room_for_parcels(std::span<const std::uint64_t> counts,
                                                                   std::span<const std::vector<std::uint32_t>> knowers,
                                                                   const Communicator& ranks) {
    std::vector<std::size_t> sizes(ranks.size(), 0);
    for (std::size_t column = 0; column < counts.size(); ++column)
      for (const std::uint32_t rank : knowers[column])
        sizes[rank] += rank == ranks.rank() ? 0 : counts[column];
    std::vector<std::vector<InsideParticle>> parcels(ranks.size());
    for (std::size_t rank = 0; rank < sizes.size(); ++rank)
      parcels[rank].reserve(sizes[rank]);
    return parcels;
  }

  std::vector<std::vector<std::uint32_t>> sent_;  // to owners, own ones in the order sent
  std::vector<std::vector<std::uint32_t>> owned_; // of each rank's that stand in this one's columns, which ones
};

// The columns of all ranks in one half spectrum, and which of its blocks are whose. Ranks transform the columns that
// they only feel, too: what they have there does not count, for these are later ranks' own.
struct SpectrumOfAll {
  std::vector<IndexRange> columns, blocks;
};

SpectrumOfAll spectrum_of_all(std::span<const MeshShare> shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return shares[a].pulled.begin < shares[b].pulled.begin; });
  SpectrumOfAll all{{}, std::vector<IndexRange>(shares.size())};
  std::size_t next = 0;
  for (const std::size_t rank : order) {
    const IndexRange& its = shares[rank].pulled;
    const std::size_t count = (its.size() + HalfSpectrum::block - 1) / HalfSpectrum::block;
    all.columns.push_back(its);
    all.blocks[rank] = {next, next + count};
    next += count;
  }
  return all;
}

} // namespace

// What a rank knows in a solve: the shares of all, and the particles in its own one.
struct FftSolver::Parts::Known {
  MeshShape shape;
  double offset_part; // of the box's length
  std::vector<MeshShare> shares;
  MeshShare own;
  SpectrumOfAll spectrum;
  Guests guests;

  std::size_t first_tile(const Tiling& tiling) const { return own.own.begin * tiling.tile_rows(); }
  std::size_t tiles(const Tiling& tiling) const { return own.own.size() * tiling.tile_rows(); }
};

// Collective: chooses the mesh, shares it, and puts the particles in order that this rank must know.
FftSolver::Parts::Known FftSolver::Parts::know(const GravityProblem& problem, double offset, bool with_neighbours) {
  const Communicator& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  const MeshShape shape = choose_mesh(problem.box, common_extent(problem), count);
  const Tiling tiling = tiling_for(shape, count);
  put_inside(problem, offset, inside);
  const TileFinder find(tiling, problem.box);
  const std::vector<std::uint64_t> here = count_in_columns(inside, tiling, find);
  std::vector<MeshShare> shares = shares_of(here, shape, tiling, problem.box, with_neighbours ? radius : 0.0, ranks);
  const MeshShare own = shares[ranks.rank()];
  Guests guests(inside, here, find, shares, tiling, ranks);
  places.sort(inside, problem.box, tiling, own.known, common_mass_unit(problem, count));
  SpectrumOfAll spectrum = spectrum_of_all(shares);
  return {shape, offset / problem.box.size_y, std::move(shares), own, std::move(spectrum), std::move(guests)};
}

// Spreads the masses on the share's nodes; some waves of the whole mesh are then this rank's.
void FftSolver::Parts::turn_to_waves(const Communicator& ranks, const Known& known) {
  const MeshShare& own = known.own;
  const MeshShape& shape = known.shape;
  mesh.reset(shape, own.stored);
  mesh.spread(places, own.spread, kernels);
  transform.prepare(shape, known.offset_part, own.waves);
  waves.prepare(shape);

  by_columns.reset({&own.pulled, 1}, {0, transform.waves()}, shape.planes);
  transform.forward_y(mesh, by_columns);
  // the mesh's values are not needed until there are new ones
  by_waves.reset(known.spectrum.columns, own.waves, shape.planes,
                 AlignedArray<std::complex<float>>(mesh.take_memory()));
  ranks.exchange(columns_of_share(known), waves_of_share(known));
}

// Of its columns, for each rank the waves that are that one's.
std::vector<Blocks> FftSolver::Parts::columns_of_share(const Known& known) {
  std::vector<Blocks> parts;
  for (const MeshShare& its : known.shares)
    parts.push_back(by_columns.part({0, by_columns.blocks()}, its.waves));
  return parts;
}

// Of its waves, for each rank the columns that are that one's.
std::vector<Blocks> FftSolver::Parts::waves_of_share(const Known& known) {
  std::vector<Blocks> parts;
  for (const IndexRange& blocks : known.spectrum.blocks)
    parts.push_back(by_waves.part(blocks, known.own.waves));
  return parts;
}

// Turns the masses into the potential that the share's particles feel.
void FftSolver::Parts::fill_share(const Communicator& ranks, const Known& known) {
  turn_to_waves(ranks, known);
  transform.change_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(known.shape, transform, m, kernels, from, to);
  });
  ranks.exchange(waves_of_share(known), columns_of_share(known));
  mesh.give_memory(AlignedArray<float>(by_waves.take_memory()));
  transform.backward_y(by_columns, mesh);
}

void FftSolver::Parts::accelerate_share(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const Communicator& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  const Known known = know(problem, offset, settings.short_range);
  fill_share(ranks, known);

  // what the transforms had there is not needed until the next solve
  AlignedArray<Vec3> memory(by_columns.take_memory());
  memory.resize_at_least(places.count());
  const std::span<Vec3> pulls(memory.data(), places.count());
  std::vector<Vec3> sums(known.tiles(places.tiling()));
  const std::size_t first = known.first_tile(places.tiling());
  parallel_for(
      sums.size(), [&](std::size_t k) { sums[k] = accelerate_tile(problem, offset, first + k, pulls); }, 4);
  auto total = exact_total<ExactVec3>(sums.size(), [&](ExactVec3& all, std::size_t k) { all += sums[k]; });
  ranks.merge({&total.x, &total.y, &total.z});
  const Vec3 mean = total.value() / static_cast<double>(count); // as on one process
  known.guests.send_home(pulls, ranks, [&](std::size_t k, const Vec3& a) { accelerations[k] = a - mean; });
  by_columns.give_memory(AlignedArray<std::complex<float>>(std::move(memory)));
}

double FftSolver::Parts::fraction_of_potential(const GravityProblem& problem, double offset) {
  const Known known = know(problem, offset, false);
  turn_to_waves(problem.ranks, known);
  std::vector<double> sums(known.own.waves.size());
  transform.visit_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(known.shape, transform, m, kernels, from, to);
    sums[m - known.own.waves.begin] = wave_potential(m, from, to);
  });
  mesh.give_memory(AlignedArray<float>(by_waves.take_memory()));
  auto sum = exact_total<ExactSum>(sums.size(), [&](ExactSum& all, std::size_t k) { all += sums[k]; });
  const std::size_t tiles = known.tiles(places.tiling()), first = known.first_tile(places.tiling());
  ExactSum squares;
  if (tiles > 0)
    squares = squared_masses(places.first(first), places.end(first + tiles - 1));
  problem.ranks.merge({&sum, &squares});
  return sum.value() - 0.5 * squares.value() * split.potential()[0] / radius;
}

NearForces::Energy FftSolver::Parts::fraction_of_near_energy(const GravityProblem& problem, double offset) {
  const Known known = know(problem, offset, true);
  NearSums sums = near_sums(problem.box, offset, known.first_tile(places.tiling()), known.tiles(places.tiling()));
  problem.ranks.merge({&sums.potential, &sums.stress});
  return {sums.potential.value(), sums.stress.value()};
}

} // namespace keeler
