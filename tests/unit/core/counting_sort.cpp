#include <keeler/core/counting_sort.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

namespace counting_sort_test {

using namespace keeler;

namespace {

struct Sorted {
  std::vector<std::uint32_t> starts, order;
  bool operator==(const Sorted&) const = default;
};

Sorted sorted(const std::vector<std::uint32_t>& cell_of, std::size_t cells) {
  Sorted result;
  result.order.resize(cell_of.size());
  counting_sort(cell_of, cells, result.starts,
                [&](std::size_t k, std::size_t place) { result.order[place] = static_cast<std::uint32_t>(k); });
  return result;
}

// The plain algorithm as reference.
Sorted twin(const std::vector<std::uint32_t>& cell_of, std::size_t cells) {
  Sorted result;
  result.order.resize(cell_of.size());
  std::iota(result.order.begin(), result.order.end(), 0);
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::uint32_t i, std::uint32_t j) { return cell_of[i] < cell_of[j]; });
  for (std::uint32_t c = 0; c <= cells; ++c)
    result.starts.push_back(static_cast<std::uint32_t>(
        std::count_if(cell_of.begin(), cell_of.end(), [&](std::uint32_t cell) { return cell < c; })));
  return result;
}

} // namespace

TEST_CASE("items are sorted by cell and keep their order within one, for any number of threads") {
  const int before = threads();
  for (const int thread_count : {1, 2, 3, 8}) {
    set_threads(thread_count);
    RandomStream random(1, RandomPurpose::position, 0);
    for (const std::size_t cells : {std::size_t{1}, std::size_t{7}, std::size_t{500}})
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1024}, std::size_t{5000}}) {
        std::vector<std::uint32_t> anyhow(count), nearly(count);
        for (std::size_t k = 0; k < count; ++k) {
          const double number = random.uniform();
          anyhow[k] = static_cast<std::uint32_t>(number * number * static_cast<double>(cells)); // crowded at one end
          nearly[k] = static_cast<std::uint32_t>(std::min(cells - 1, k * cells / count + (k % 5 == 0 ? 1 : 0)));
        }
        CHECK(sorted(anyhow, cells) == twin(anyhow, cells));
        CHECK(sorted(nearly, cells) == twin(nearly, cells));
      }
  }
  set_threads(before);
}

} // namespace counting_sort_test
