#include <keeler/particles/by_id.hpp>

#include <keeler/core/parallel.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <vector>

namespace keeler::particles {
namespace {

template<class Row> std::vector<Row> rows_at(const std::vector<Row>& rows, std::span<const std::uint32_t> indices) {
  std::vector<Row> selected(indices.size());
  parallel_for(indices.size(), [&](std::size_t k) { selected[k] = rows[indices[k]]; });
  return selected;
}

Particles particles_at(const Particles& particles, std::span<const std::uint32_t> indices) {
  Particles selected;
  selected.bodies = rows_at(particles.bodies, indices);
  selected.ids = rows_at(particles.ids, indices);
  selected.rough = particles.rough;
  if (selected.rough)
    selected.spins = rows_at(particles.spins, indices);
  return selected;
}

// Gathers the particles of all ranks on the root, sorted by id. Collective.
Particles gathered(const Particles& here, const Communicator& ranks) {
  Particles all;
  all.bodies = ranks.gather(here.bodies);
  all.ids = ranks.gather(here.ids);
  all.rough = here.rough;
  if (all.rough)
    all.spins = ranks.gather(here.spins);
  return particles_at(all, order_by_id(all.ids));
}

// The local particles in order of id that have not been taken yet.
class Remaining {
public:
  explicit Remaining(const Particles& local) : local_(local), order_(order_by_id(local.ids)) {}

  std::size_t size() const { return order_.size() - taken_; }

  /// Returns the number of remaining ids below `bound`.
  std::size_t below(std::uint64_t bound) const {
    const auto is_below = [&](std::uint32_t k, std::uint64_t value) { return local_.ids[k] < value; };
    const auto first = order_.begin() + static_cast<std::ptrdiff_t>(taken_);
    return static_cast<std::size_t>(std::lower_bound(first, order_.end(), bound, is_below) - first);
  }

  /// Returns the next particles. Precondition: count <= size().
  Particles take(std::size_t count) {
    assert(count <= size());
    const auto indices = std::span(order_).subspan(taken_, count);
    taken_ += count;
    return particles_at(local_, indices);
  }

private:
  const Particles& local_;
  std::vector<std::uint32_t> order_;
  std::size_t taken_ = 0;
};

// Returns the id below which all ranks together have `count` remaining particles. The first guess is right if ids are
// consecutive; otherwise the id is found by bisection. Collective. Precondition: no remaining id is below `low`, and
// more than `count` particles remain.
std::uint64_t find_bound(const Remaining& remaining, const Communicator& ranks, std::uint64_t low, std::size_t count) {
  const auto below = [&](std::uint64_t bound) { return ranks.sum(static_cast<std::uint64_t>(remaining.below(bound))); };
  std::uint64_t bound = low + count, high = std::numeric_limits<std::uint64_t>::max();
  for (std::uint64_t found = below(bound); found != count && high - low > 1; found = below(bound)) {
    (found < count ? low : high) = bound;
    bound = low + (high - low) / 2;
  }
  return bound;
}

} // namespace

void visit_by_id(const Particles& local, const Communicator& ranks, std::size_t rows,
                 const std::function<void(const Particles&)>& piece) {
  assert(rows > 0 && local.ids.size() == local.size());
  Remaining remaining(local);
  std::uint64_t bound = 0;
  for (std::size_t left = ranks.sum(local.size()); left > 0;) {
    const std::size_t count = std::min(rows, left);
    left -= count;
    std::size_t here = std::min(count, remaining.size());
    if (ranks.distributed()) {
      if (left > 0)
        bound = find_bound(remaining, ranks, bound, count);
      here = left > 0 ? remaining.below(bound) : remaining.size();
    }
    Particles all = remaining.take(here);
    if (ranks.distributed())
      all = gathered(all, ranks);
    ranks.on_root([&] { piece(all); });
  }
}

// Finds all ids at once by bisection: the largest bound below which there are at most `place` ids.
std::vector<std::uint64_t> ids_at(std::span<const std::uint64_t> local_ids, const Communicator& ranks,
                                  std::span<const std::size_t> places) {
  std::vector<std::uint64_t> sorted(local_ids.begin(), local_ids.end()), ids(places.size(), 0);
  std::sort(sorted.begin(), sorted.end());
  for (int bit = 63; bit >= 0; --bit) {
    std::vector<std::uint64_t> below(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      below[k] = static_cast<std::uint64_t>(
          std::lower_bound(sorted.begin(), sorted.end(), ids[k] + (std::uint64_t{1} << bit)) - sorted.begin());
    ranks.sum(below);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (below[k] <= places[k])
        ids[k] += std::uint64_t{1} << bit;
  }
  return ids;
}

} // namespace keeler::particles
