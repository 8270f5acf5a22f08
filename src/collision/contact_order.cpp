// Each slice of the step is sorted by itself, so that threads can share the work.
#include "contact_order.hpp"

#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>
#include <tuple>

namespace keeler::collision {
namespace {

constexpr std::size_t contacts_per_slice = 512;

// Merges contacts at one instant, which are sorted by domain: of the next contacts of all domains, the one with the
// least ids comes first.
template<class IdsOf> void merge_tied(std::span<ContactTurn> tied, const IdsOf& ids_of) {
  std::vector<ContactTurn> left(tied.begin(), tied.end());
  for (ContactTurn& next : tied) {
    auto least = left.begin();
    for (auto turn = left.begin() + 1; turn < left.end(); ++turn)
      if (turn->domain != (turn - 1)->domain && ids_of(*turn) < ids_of(*least))
        least = turn;
    next = *least;
    left.erase(least);
  }
}

} // namespace

void ContactOrder::collect(std::span<const OptimisticDomain> domains) {
  of_domain_.resize(domains.size());
  parallel_for(
      domains.size(),
      [&](std::size_t d) {
        const DomainContacts& log = domains[d].contacts;
        Turns& turns = of_domain_[d];
        turns.clear();
        for (std::size_t k = log.next_valid(0); k < log.size(); k = log.next_valid(k + 1)) {
          assert(turns.empty() || turns.back().time <= log[k].time);
          turns.push_back({log[k].time, static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(k)});
        }
      },
      1);
}

bool ContactOrder::sort(std::span<const OptimisticDomain> domains, std::size_t first_late, const StepContext& step) {
  collect(domains);
  std::size_t count = 0;
  for (const Turns& turns : of_domain_)
    count += turns.size();
  all_.resize(count);
  const std::size_t slices = 1 + count / std::max(contacts_per_slice, 8 * domains.size());
  const auto begin_in = [&](const Turns& turns, std::size_t slice) {
    const double part = static_cast<double>(slice) / static_cast<double>(slices);
    const double from = step.begin + (step.end() - step.begin) * part;
    return slice == slices ? turns.end()
                           : std::lower_bound(turns.begin(), turns.end(), from,
                                              [](const ContactTurn& turn, double time) { return turn.time < time; });
  };
  const auto ids_of = [&](const ContactTurn& turn) {
    const Contact& contact = domains[turn.domain].contacts[turn.contact];
    return std::pair(step.particles.ids[contact.low], step.particles.ids[contact.high]);
  };
  std::vector<std::uint8_t> is_undecided(slices, 0);
  const auto sort_slice = [&](std::size_t slice) {
    std::size_t before = 0;
    for (const Turns& turns : of_domain_)
      before += static_cast<std::size_t>(begin_in(turns, slice) - turns.begin());
    const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(before);
    auto end = begin;
    for (const Turns& turns : of_domain_)
      end = std::copy(begin_in(turns, slice), begin_in(turns, slice + 1), end);
    std::sort(begin, end, [](const ContactTurn& a, const ContactTurn& b) {
      return std::tuple(a.time, a.domain, a.contact) < std::tuple(b.time, b.domain, b.contact);
    });
    for (auto first = begin, last = begin; first < end; first = last) {
      while (last < end && last->time == first->time)
        ++last;
      is_undecided[slice] |= last - first > 1 && (last - 1)->domain >= first_late;
      if (first->domain != (last - 1)->domain)
        merge_tied({first, last}, ids_of);
    }
  };
  parallel_for(slices, sort_slice, 1);
  return std::find(is_undecided.begin(), is_undecided.end(), 1) == is_undecided.end();
}

std::size_t ContactOrder::bytes() const {
  std::size_t total = all_.capacity() * sizeof(ContactTurn) + of_domain_.capacity() * sizeof(Turns);
  for (const Turns& turns : of_domain_)
    total += turns.capacity() * sizeof(ContactTurn);
  return total;
}

} // namespace keeler::collision
