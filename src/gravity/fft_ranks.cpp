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

std::vector<InsideParticle> put_inside(const GravityProblem& problem, double offset) {
  std::vector<InsideParticle> inside(problem.positions.size());
  parallel_for(inside.size(), [&](std::size_t k) {
    const Vec3 p = into_cell(problem.box, offset, problem.positions[k]);
    inside[k] = {p.x(), p.y(), p.z(), problem.masses[k], problem.ids[k]};
  });
  const double farthest = largest_of(inside.size(), [&](std::size_t k) { return std::fabs(inside[k].x); });
  problem.ranks.together([&] {
    if (!(farthest <= 0.5 * (1.0 + loose_edge) * problem.box.size_x))
      throw InvariantError("a particle stands too far away to be put into the box; take a shorter time.step");
  });
  return inside;
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
void deal_out(std::vector<MeshShare>& shares, std::span<const std::uint64_t> here, const Ranks& ranks) {
  std::vector<std::uint64_t> stay(shares.size(), 0); // by how far the shares are turned
  for (std::size_t turn = 0; turn < stay.size(); ++turn) {
    const IndexRange& own = shares[(ranks.own() + turn) % shares.size()].own;
    const auto its = here.subspan(own.begin, own.size());
    stay[turn] = std::accumulate(its.begin(), its.end(), std::uint64_t{0});
  }
  ranks.sum(std::span(stay));
  std::rotate(shares.begin(), shares.begin() + (std::max_element(stay.begin(), stay.end()) - stay.begin()),
              shares.end());
}

// Collective: the share of each rank.
std::vector<MeshShare> shares_of(std::span<const InsideParticle> particles, const MeshShape& shape,
                                 const Tiling& tiling, const ShearingBox& box, double reach, const Ranks& ranks) {
  const std::vector<std::uint64_t> here = count_in_columns(particles, tiling, TileFinder(tiling, box));
  std::vector<std::uint64_t> all = here;
  ranks.sum(std::span(all));
  std::vector<MeshShare> shares = share_mesh(shape, tiling, box, reach, all, ranks.count());
  deal_out(shares, here, ranks);
  return shares;
}

bool is_in(const IndexRange& range, std::size_t column) {
  return column >= range.begin && column < range.end;
}

// The particles that a rank must know, and the way home of what becomes of its own ones. Most stay where they are.
class Guests {
public:
  /// Collective: sends particles to all that must know them.
  Guests(std::span<const InsideParticle> own, const TileFinder& find, std::span<const MeshShare> shares,
         const Tiling& tiling, const Ranks& ranks)
      : find_(find), here_(shares[ranks.own()].own), sent_(ranks.count()), from_(ranks.count()) {
    const auto knowers = who_must_know(shares, tiling);
    std::vector<std::vector<InsideParticle>> parcels(ranks.count());
    particles_.reserve(own.size() + own.size() / 2);
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::size_t column = find.column(own[k].x);
      for (const std::uint32_t rank : knowers[column]) {
        (rank == ranks.own() ? particles_ : parcels[rank]).push_back(own[k]);
        if (is_in(shares[rank].own, column))
          sent_[rank].push_back(static_cast<std::uint32_t>(k));
      }
    }
    from_[ranks.own()] = {0, particles_.size()};
    parcels = ranks.exchange(parcels);
    for (std::size_t rank = 0; rank < parcels.size(); ++rank) {
      if (rank == ranks.own())
        continue;
      from_[rank] = {particles_.size(), particles_.size() + parcels[rank].size()};
      particles_.insert(particles_.end(), parcels[rank].begin(), parcels[rank].end());
      std::vector<InsideParticle>().swap(parcels[rank]);
    }
  }

  std::span<const InsideParticle> particles() const { return particles_; }

  /// Collective: from values of particles(), that of each particle comes home from its owner in the mesh.
  template<class Take> void send_home(std::span<const Vec3> values, const Ranks& ranks, const Take& take) const {
    using Row = std::array<double, 3>;
    std::vector<std::vector<Row>> rows(ranks.count());
    const auto visit_owned = [&](std::size_t rank, const auto& visit) {
      for (std::size_t k = from_[rank].begin; k < from_[rank].end; ++k)
        if (is_in(here_, find_.column(particles_[k].x)))
          visit(values[k]);
    };
    for (std::size_t rank = 0; rank < rows.size(); ++rank)
      if (rank != ranks.own())
        visit_owned(rank, [&](const Vec3& value) { rows[rank].push_back({value.x(), value.y(), value.z()}); });
    rows = ranks.exchange(rows);
    auto own = sent_[ranks.own()].begin();
    visit_owned(ranks.own(), [&](const Vec3& value) { take(*own++, value); });
    for (std::size_t rank = 0; rank < rows.size(); ++rank) {
      assert(rank == ranks.own() || rows[rank].size() == sent_[rank].size());
      for (std::size_t i = 0; i < rows[rank].size(); ++i)
        take(sent_[rank][i], Vec3(rows[rank][i][0], rows[rank][i][1], rows[rank][i][2]));
    }
  }

private:
  TileFinder find_;
  IndexRange here_;
  std::vector<std::vector<std::uint32_t>> sent_; // to owners, in the order sent
  std::vector<InsideParticle> particles_;        // own ones first
  std::vector<IndexRange> from_;                 // each rank, these
};

// A part of a half spectrum.
struct Piece {
  IndexRange columns, waves;

  std::size_t count(std::size_t planes) const { return columns.size() * waves.size() * planes; }
};

// Numbers of one wave and plane that stand together, from a column on.
struct Run {
  HalfSpectrum::Complex* numbers;
  std::size_t count;
};

Run run_at(HalfSpectrum& half, std::size_t wave, std::size_t plane, std::size_t column) {
  constexpr std::size_t block = HalfSpectrum::block;
  const std::size_t place = column - half.columns().begin, in_block = place % block;
  return {half.wave(place / block, wave) + plane * block + in_block, block - in_block};
}

// Calls row(wave, plane, at) for all rows of columns of a piece; `at` counts their numbers wave by wave, plane by
// plane.
template<class Row> void for_each_row(const Piece& piece, std::size_t planes, const Row& row) {
  parallel_for(
      piece.waves.size(),
      [&](std::size_t w) {
        for (std::size_t plane = 0; plane < planes; ++plane)
          row(piece.waves.begin + w, plane, (w * planes + plane) * piece.columns.size());
      },
      4);
}

// Calls move(numbers, at, count) for all numbers of a piece, some columns of one plane at a time.
template<class Move> void visit(HalfSpectrum& half, const Piece& piece, const Move& move) {
  for_each_row(piece, half.planes(), [&](std::size_t wave, std::size_t plane, std::size_t at) {
    for (std::size_t column = piece.columns.begin; column < piece.columns.end;) {
      const Run run = run_at(half, wave, plane, column);
      const std::size_t count = std::min(run.count, piece.columns.end - column);
      move(run.numbers, at, count);
      column += count;
      at += count;
    }
  });
}

// The piece that stays on this rank.
void copy(HalfSpectrum& from, HalfSpectrum& to, const Piece& piece) {
  for_each_row(piece, from.planes(), [&](std::size_t wave, std::size_t plane, std::size_t) {
    for (std::size_t column = piece.columns.begin; column < piece.columns.end;) {
      const Run old = run_at(from, wave, plane, column), its = run_at(to, wave, plane, column);
      const std::size_t count = std::min({old.count, its.count, piece.columns.end - column});
      std::copy_n(old.numbers, count, its.numbers);
      column += count;
    }
  });
}

// Collective: hands the pieces of `from` to the ranks and gets those of `to`.
void turn_over(const Ranks& ranks, HalfSpectrum& from, std::span<const Piece> sent, HalfSpectrum& to,
               std::span<const Piece> received) {
  constexpr std::size_t size = sizeof(HalfSpectrum::Complex);
  Parcels parcels(ranks.count());
  for (std::size_t rank = 0; rank < ranks.count(); ++rank) {
    if (rank == ranks.own())
      continue;
    parcels[rank].resize(size * sent[rank].count(from.planes()));
    std::byte* const bytes = parcels[rank].data();
    visit(from, sent[rank], [&](const HalfSpectrum::Complex* numbers, std::size_t at, std::size_t count) {
      std::memcpy(bytes + size * at, numbers, size * count);
    });
  }
  parcels = ranks.exchange(std::move(parcels));
  copy(from, to, sent[ranks.own()]);
  for (std::size_t rank = 0; rank < ranks.count(); ++rank) {
    if (rank == ranks.own())
      continue;
    assert(parcels[rank].size() == size * received[rank].count(to.planes()));
    const std::byte* const bytes = parcels[rank].data();
    visit(to, received[rank], [&](HalfSpectrum::Complex* numbers, std::size_t at, std::size_t count) {
      std::memcpy(static_cast<void*>(numbers), bytes + size * at, size * count);
    });
  }
}

// What lies behind the last column is turned with it, so it must be numbers.
void clear_last_block(HalfSpectrum& half) {
  for (std::size_t m = half.waves().begin; m < half.waves().end; ++m) {
    HalfSpectrum::Complex* const last = half.wave(half.blocks() - 1, m);
    std::fill(last, last + half.planes() * HalfSpectrum::block, 0.0f);
  }
}

template<class Of> std::vector<Piece> pieces(std::span<const MeshShare> shares, const Of& of) {
  std::vector<Piece> result;
  for (const MeshShare& share : shares)
    result.push_back(of(share));
  return result;
}

} // namespace

// What a rank knows in a solve: the shares of all, and the particles in its own one.
struct FftSolver::Parts::Known {
  MeshShape shape;
  double offset_part; // of the box's length
  std::vector<MeshShare> shares;
  MeshShare own;
  Guests guests;

  std::size_t first_tile(const Tiling& tiling) const { return own.own.begin * tiling.tile_rows(); }
  std::size_t tiles(const Tiling& tiling) const { return own.own.size() * tiling.tile_rows(); }
};

// Collective: chooses the mesh, shares it, and puts the particles in order that this rank must know.
FftSolver::Parts::Known FftSolver::Parts::know(const GravityProblem& problem, double offset, bool with_neighbours) {
  const Ranks& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  const MeshShape shape = choose_mesh(problem.box, common_extent(problem), count);
  const Tiling tiling = tiling_for(shape, count);
  std::vector<InsideParticle> inside = put_inside(problem, offset);
  std::vector<MeshShare> shares = shares_of(inside, shape, tiling, problem.box, with_neighbours ? radius : 0.0, ranks);
  const MeshShare own = shares[ranks.own()];
  Guests guests(inside, TileFinder(tiling, problem.box), shares, tiling, ranks);
  std::vector<InsideParticle>().swap(inside);
  places.sort(guests.particles(), problem.box, tiling, own.known, common_mass_unit(problem, count));
  return {shape, offset / problem.box.size_y, std::move(shares), own, std::move(guests)};
}

// Spreads the masses on the share's nodes; some waves of the whole mesh are then this rank's.
void FftSolver::Parts::turn_to_waves(const Ranks& ranks, const Known& known) {
  const MeshShare& own = known.own;
  const MeshShape& shape = known.shape;
  mesh.reset(shape, own.stored);
  mesh.spread(places, own.spread, kernels);
  transform.prepare(shape, known.offset_part, own.waves);
  waves.prepare(shape);

  by_columns.reset(own.nodes, {0, transform.waves()}, shape.planes);
  transform.forward_y(mesh, by_columns);
  by_waves.reset({0, shape.columns + MeshShape::ghosts}, own.waves, shape.planes);
  clear_last_block(by_waves);
  turn_over(ranks, by_columns,
            pieces(known.shares,
                   [&](const MeshShare& its) {
                     return Piece{own.nodes, its.waves};
                   }),
            by_waves, pieces(known.shares, [&](const MeshShare& its) {
              return Piece{its.nodes, own.waves};
            }));
}

// Turns the masses into the potential that the share's particles feel.
void FftSolver::Parts::fill_share(const Ranks& ranks, const Known& known) {
  const MeshShare& own = known.own;
  turn_to_waves(ranks, known);
  transform.change_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(known.shape, transform, m, kernels, from, to);
  });
  by_columns.reset(own.pulled, {0, transform.waves()}, known.shape.planes);
  turn_over(ranks, by_waves,
            pieces(known.shares,
                   [&](const MeshShare& its) {
                     return Piece{its.pulled, own.waves};
                   }),
            by_columns, pieces(known.shares, [&](const MeshShare& its) {
              return Piece{own.pulled, its.waves};
            }));
  transform.backward_y(by_columns, mesh);
}

void FftSolver::Parts::accelerate_share(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const Ranks& ranks = problem.ranks;
  const std::uint64_t count = ranks.sum(problem.positions.size());
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  const Known known = know(problem, offset, settings.short_range);
  fill_share(ranks, known);

  std::vector<Vec3> here(known.guests.particles().size());
  std::vector<Vec3> sums(known.tiles(places.tiling()));
  const std::size_t first = known.first_tile(places.tiling());
  parallel_for(
      sums.size(), [&](std::size_t k) { sums[k] = accelerate_tile(problem, offset, first + k, here); }, 4);
  auto total = exact_total<ExactVec3>(sums.size(), [&](ExactVec3& all, std::size_t k) { all += sums[k]; });
  ranks.merge({&total.x, &total.y, &total.z});
  const Vec3 mean = total.value() / static_cast<double>(count); // as on one process
  known.guests.send_home(here, ranks, [&](std::size_t k, const Vec3& a) { accelerations[k] = a - mean; });
}

double FftSolver::Parts::share_of_potential(const GravityProblem& problem, double offset) {
  const Known known = know(problem, offset, false);
  turn_to_waves(problem.ranks, known);
  std::vector<double> sums(known.own.waves.size());
  transform.visit_waves(by_waves, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(known.shape, transform, m, kernels, from, to);
    sums[m - known.own.waves.begin] = wave_potential(m, from, to);
  });
  auto sum = exact_total<ExactSum>(sums.size(), [&](ExactSum& all, std::size_t k) { all += sums[k]; });
  const std::size_t tiles = known.tiles(places.tiling()), first = known.first_tile(places.tiling());
  ExactSum squares;
  if (tiles > 0)
    squares = squared_masses(places.first(first), places.end(first + tiles - 1));
  problem.ranks.merge({&sum, &squares});
  return sum.value() - 0.5 * squares.value() * split.potential()[0] / radius;
}

NearForces::Energy FftSolver::Parts::share_of_near_energy(const GravityProblem& problem, double offset) {
  const Known known = know(problem, offset, true);
  NearSums sums = near_sums(problem.box, offset, known.first_tile(places.tiling()), known.tiles(places.tiling()));
  problem.ranks.merge({&sums.potential, &sums.stress});
  return {sums.potential.value(), sums.stress.value()};
}

} // namespace keeler
