// The direct sum for a sample, over the particles of many ranks, with the bits of one process: it adds sources in the
// order of their ids. So each rank gets the sources of a range of ids, and the sums of a bundle of targets go from rank
// to rank, once round for each image. Bundles follow each other, so that all ranks work.
#include "direct_sources.hpp"
#include "far_images.hpp"
#include "gathered.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/particles/by_id.hpp>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>
#include <utility>

namespace keeler::gravity {
namespace {

constexpr std::size_t lanes = 16;
// parts of the sources are multiples of this: of the kernels' partial sums, and of a block of far images
constexpr std::size_t unit_of_parts = FarBlock<double>::capacity;
static_assert(unit_of_parts % 128 == 0);

struct SourceRow {
  PointSource source;
  std::uint64_t id;
};

// This rank's part of the sources in the order of the ids, folded into the cell. Ranks exchange them in batches, so
// that only one of these is in memory twice.
std::vector<SourceRow> sources_by_id(const GravityProblem& problem, double offset, std::size_t count) {
  const Communicator& ranks = problem.ranks;
  std::vector<std::size_t> places; // of the first source of each rank but the root
  for (std::size_t rank = 1; rank < ranks.size(); ++rank)
    places.push_back(count * rank / ranks.size() / unit_of_parts * unit_of_parts);
  const std::vector<std::uint64_t> first = particles::ids_at(problem.ids, ranks, places);
  places.insert(places.begin(), 0);
  places.push_back(count);
  const std::size_t own = places[ranks.rank() + 1] - places[ranks.rank()];
  std::vector<SourceRow> rows;
  rows.reserve(own);
  constexpr std::size_t batches = 16;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    std::vector<std::vector<SourceRow>> sent(ranks.size());
    const std::size_t end = problem.ids.size() * (batch + 1) / batches;
    for (std::size_t k = problem.ids.size() * batch / batches; k < end; ++k) {
      const auto rank = std::upper_bound(first.begin(), first.end(), problem.ids[k]) - first.begin();
      const Vec3 p = into_cell(problem.box, offset, problem.positions[k]);
      sent[static_cast<std::size_t>(rank)].push_back({{p.x(), p.y(), p.z(), problem.masses[k]}, problem.ids[k]});
    }
    for (const std::vector<SourceRow>& some : ranks.exchange(sent))
      rows.insert(rows.end(), some.begin(), some.end());
  }
  assert(rows.size() == own);
  std::sort(rows.begin(), rows.end(), [](const SourceRow& a, const SourceRow& b) { return a.id < b.id; });
  return rows;
}

// Returns the particles with the ids of the sample, in its order, on all ranks.
std::vector<PointSource> targets_of(std::span<const std::uint64_t> sample, const std::vector<SourceRow>& rows,
                                    const Communicator& ranks) {
  std::vector<SourceRow> here;
  for (const std::uint64_t id : sample) {
    const auto found = std::lower_bound(rows.begin(), rows.end(), id,
                                        [](const SourceRow& row, std::uint64_t sought) { return row.id < sought; });
    if (found != rows.end() && found->id == id)
      here.push_back(*found);
  }
  const std::vector<SourceRow> all = ranks.gather_on_all(std::span<const SourceRow>(here));
  std::vector<PointSource> targets;
  for (const std::uint64_t id : sample) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const SourceRow& row) { return row.id == id; });
    assert(found != all.end());
    targets.push_back(found->source);
  }
  return targets;
}

// Sends some rows to the next rank and receives as many from the last one; either may be none.
template<class Row> void pass_on(std::span<const Row> to_next, std::span<Row> from_last, const Communicator& ranks) {
  std::vector<comm::Blocks> sent(ranks.size()), received(ranks.size());
  const auto block = [](auto rows) {
    auto* const first = const_cast<Row*>(rows.data());
    return comm::Blocks{reinterpret_cast<std::byte*>(first), 1, rows.size_bytes(), rows.size_bytes()};
  };
  if (!to_next.empty())
    sent[(ranks.rank() + 1) % ranks.size()] = block(to_next);
  if (!from_last.empty())
    received[(ranks.rank() + ranks.size() - 1) % ranks.size()] = block(from_last);
  ranks.exchange(sent, received);
}

// The way of the bundles: at each time a rank adds its sources, at one shift, to one bundle.
struct Round {
  std::size_t ranks, bundles, shifts;

  struct Turn {
    std::size_t bundle = 0, shift = 0;
    bool works = false;
  };
  // Bundle b begins at rank 0 at time b.
  Turn turn(std::size_t rank, std::size_t time) const {
    for (std::size_t b = 0; b < bundles; ++b)
      if (time >= b + rank && (time - b - rank) % ranks == 0 && (time - b - rank) / ranks < shifts)
        return {b, (time - b - rank) / ranks, true};
    return {};
  }
  bool is_last(std::size_t rank, const Turn& turn) const { return rank + 1 == ranks && turn.shift + 1 == shifts; }
  std::size_t times() const { return ranks * shifts + bundles - 1; }
};

// Returns the sums over all sources and near images, on all ranks.
std::vector<Vec3> near_sums_of_ranks(const DirectSources& sources, const std::vector<PointSource>& targets,
                                     const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                                     const Communicator& ranks) {
  std::vector<Vec3> sums(targets.size(), Vec3::Zero());
  const std::size_t blocks = (targets.size() + lanes - 1) / lanes;
  const Round round{ranks.size(), std::min(ranks.size(), blocks), shifts.size()};
  const auto block_begin = [&](std::size_t block) { return std::min(block * lanes, targets.size()); };
  const auto first_block = [&](std::size_t bundle) { return blocks * bundle / round.bundles; };
  const auto bundle_of = [&](std::size_t bundle) {
    const std::size_t begin = block_begin(first_block(bundle)), end = block_begin(first_block(bundle + 1));
    return std::span(sums).subspan(begin, end - begin);
  };
  const std::size_t rank = ranks.rank(), last = (rank + ranks.size() - 1) % ranks.size();
  for (std::size_t time = 0; time < round.times(); ++time) {
    const Round::Turn turn = round.turn(rank, time), of_last = round.turn(last, time);
    std::span<Vec3> to_next, from_last;
    if (turn.works) {
      const std::size_t begin = first_block(turn.bundle), end = first_block(turn.bundle + 1);
      parallel_for(
          end - begin,
          [&](std::size_t k) {
            const std::size_t first = block_begin(begin + k), count = block_begin(begin + k + 1) - first;
            sources.add_to(std::span(targets).subspan(first, count), std::span(shifts).subspan(turn.shift, 1), kernels,
                           std::span(sums).subspan(first, count));
          },
          1);
      if (!round.is_last(rank, turn))
        to_next = bundle_of(turn.bundle);
    }
    if (of_last.works && !round.is_last(last, of_last))
      from_last = bundle_of(of_last.bundle);
    pass_on<Vec3>(to_next, from_last, ranks);
  }
  if (rank + 1 < ranks.size())
    sums.clear(); // the last rank has them
  return ranks.gather_on_all(std::span<const Vec3>(sums));
}

// Returns the moments of the sources of all ranks, on all of them.
FarImages::Coefficients moments_of_ranks(const FarImages& far, const std::vector<PointSource>& sources,
                                         InstructionSet set, const Communicator& ranks) {
  FarImages::Coefficients moments = far.no_moments();
  for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
    if (rank == ranks.rank())
      far.add_moments<double>(sources, set, moments);
    const bool passes = rank + 1 < ranks.size();
    std::span<double> to_next, from_last;
    if (passes && rank == ranks.rank())
      to_next = moments;
    if (passes && rank + 1 == ranks.rank())
      from_last = moments;
    pass_on<double>(to_next, from_last, ranks);
  }
  if (ranks.rank() + 1 < ranks.size())
    moments.clear();
  return ranks.gather_on_all(std::span<const double>(moments));
}

} // namespace

std::vector<Vec3> sampled_accelerations_of_ranks(const GravityProblem& problem, std::span<const std::uint64_t> sample,
                                                 const ImageSettings& images, InstructionSet set, Precision precision) {
  const Communicator& ranks = problem.ranks;
  assert(ranks.distributed());
  const std::size_t count = ranks.sum(problem.ids.size());
  if (count <= few_bodies) {
    const GatheredParticles all(problem);
    std::vector<std::size_t> indices;
    for (const std::uint64_t id : sample)
      indices.push_back(static_cast<std::size_t>(std::find(all.problem().ids.begin(), all.problem().ids.end(), id) -
                                                 all.problem().ids.begin()));
    return sampled_accelerations(all.problem(), indices, images, set, precision);
  }
  const double offset = folded_offset(problem.box, problem.offset);
  std::vector<PointSource> sources, targets;
  {
    const std::vector<SourceRow> rows = sources_by_id(problem, offset, count);
    sources.reserve(rows.size());
    std::transform(rows.begin(), rows.end(), std::back_inserter(sources),
                   [](const SourceRow& row) { return row.source; });
    targets = targets_of(sample, rows, ranks);
  }
  const double height = ranks.max(height_of(sources));
  const ImageSettings all_images = rings_for_height(images, problem.box, height);
  const DirectSources own(sources, ranks.max(largest_mass(sources)), precision);
  std::vector<Vec3> result =
      near_sums_of_ranks(own, targets, near_images(problem.box, offset, all_images), attraction_kernels(set), ranks);
  std::vector<Vec3> far(targets.size(), Vec3::Zero());
  if (all_images.far) {
    const FarImages fit(problem.box, offset, all_images.rings, height);
    far = fit.attractions_by<double, PointSource>(moments_of_ranks(fit, sources, set, ranks), targets, set);
  }
  for (std::size_t k = 0; k < result.size(); ++k) // as sampled_accelerations() adds them
    result[k] = problem.newton_g * (own.unit() * result[k]) + problem.newton_g * far[k];
  return result;
}

} // namespace keeler::gravity
