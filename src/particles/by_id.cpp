#include <keeler/particles/by_id.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace keeler {
namespace {

template<class Row> std::vector<Row> rows_at(const std::vector<Row>& rows, std::span<const std::uint32_t> places) {
  std::vector<Row> found(places.size());
  parallel_for(places.size(), [&](std::size_t k) { found[k] = rows[places[k]]; });
  return found;
}

Particles particles_at(const Particles& particles, std::span<const std::uint32_t> places) {
  Particles found;
  found.bodies = rows_at(particles.bodies, places);
  found.ids = rows_at(particles.ids, places);
  found.rough = particles.rough;
  if (found.rough)
    found.spins = rows_at(particles.spins, places);
  return found;
}

// Collective: those of all ranks on the first one, sorted.
Particles gathered(const Particles& here, const Communicator& ranks) {
  Particles all;
  all.bodies = ranks.gather(here.bodies);
  all.ids = ranks.gather(here.ids);
  all.rough = here.rough;
  if (all.rough)
    all.spins = ranks.gather(here.spins);
  return particles_at(all, order_by_id(all.ids));
}

// The own particles by their ids, those that have not been taken yet.
class Rest {
public:
  explicit Rest(const Particles& own) : own_(own), order_(order_by_id(own.ids)) {}

  std::size_t size() const { return order_.size() - taken_; }

  /// How many have ids below that.
  std::size_t below(std::uint64_t bound) const {
    const auto is_below = [&](std::uint32_t k, std::uint64_t its) { return own_.ids[k] < its; };
    const auto first = order_.begin() + static_cast<std::ptrdiff_t>(taken_);
    return static_cast<std::size_t>(std::lower_bound(first, order_.end(), bound, is_below) - first);
  }

  Particles take(std::size_t count) {
    const auto places = std::span(order_).subspan(taken_, count);
    taken_ += count;
    return particles_at(own_, places);
  }

private:
  const Particles& own_;
  std::vector<std::uint32_t> order_;
  std::size_t taken_ = 0;
};

// Collective: the id below which the ranks' rests have `count` particles; none is below `low`, and there are more of
// them. Most ids follow each other without gaps. Where they do not, halving finds it.
std::uint64_t bound_of(const Rest& rest, const Communicator& ranks, std::uint64_t low, std::size_t count) {
  const auto below = [&](std::uint64_t bound) { return ranks.sum(static_cast<std::uint64_t>(rest.below(bound))); };
  std::uint64_t bound = low + count, high = std::numeric_limits<std::uint64_t>::max();
  for (std::uint64_t found = below(bound); found != count && high - low > 1; found = below(bound)) {
    (found < count ? low : high) = bound;
    bound = low + (high - low) / 2;
  }
  return bound;
}

} // namespace

void visit_by_id(const Particles& own, const Communicator& ranks, std::size_t rows,
                 const std::function<void(const Particles&)>& piece) {
  Rest rest(own);
  std::uint64_t bound = 0;
  for (std::size_t left = ranks.sum(own.size()); left > 0;) {
    const std::size_t count = std::min(rows, left);
    left -= count;
    std::size_t here = std::min(count, rest.size());
    if (ranks.distributed()) {
      if (left > 0)
        bound = bound_of(rest, ranks, bound, count);
      here = left > 0 ? rest.below(bound) : rest.size();
    }
    Particles all = rest.take(here);
    if (ranks.distributed())
      all = gathered(all, ranks);
    ranks.on_root([&] { piece(all); });
  }
}

} // namespace keeler
