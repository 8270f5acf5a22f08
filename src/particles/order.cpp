#include <keeler/particles/order.hpp>

#include <keeler/core/counting_sort.hpp>

#include <algorithm>

namespace keeler::particles {

// A counting sort into bins of ids, at most twice as many as particles, and then a sort within each bin. Ids are
// usually consecutive, and then each bin has one particle.
std::vector<std::uint32_t> order_by_id(std::span<const std::uint64_t> ids) {
  std::vector<std::uint32_t> order(ids.size()), bin_of(ids.size()), starts;
  if (ids.empty())
    return order;
  const std::uint64_t min = *std::min_element(ids.begin(), ids.end());
  const std::uint64_t range = *std::max_element(ids.begin(), ids.end()) - min;
  int shift = 0;
  while (range >> shift >= 2 * ids.size())
    ++shift;
  parallel_for(ids.size(), [&](std::size_t k) { bin_of[k] = static_cast<std::uint32_t>((ids[k] - min) >> shift); });
  const std::size_t bins = static_cast<std::size_t>(range >> shift) + 1;
  counting_sort(bin_of, bins, starts,
                [&](std::size_t k, std::size_t position) { order[position] = static_cast<std::uint32_t>(k); });
  if (shift > 0)
    parallel_for(bins, [&](std::size_t b) {
      std::sort(order.begin() + starts[b], order.begin() + starts[b + 1],
                [&](std::uint32_t i, std::uint32_t j) { return ids[i] < ids[j]; });
    });
  return order;
}

} // namespace keeler::particles
