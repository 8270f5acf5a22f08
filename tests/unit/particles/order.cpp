#include <keeler/particles/order.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace order_test {

using namespace keeler;
using namespace keeler::particles;

namespace {

// The plain algorithm as reference.
std::vector<std::uint32_t> twin(const std::vector<std::uint64_t>& ids) {
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) { return ids[i] < ids[j]; });
  return order;
}

} // namespace

TEST_CASE("particles are ordered by any ids") {
  CHECK(order_by_id({}).empty());
  const std::vector<std::uint64_t> farthest = {5, std::numeric_limits<std::uint64_t>::max(), 0};
  CHECK(order_by_id(farthest) == std::vector<std::uint32_t>{2, 0, 1});
  RandomStream random(1, RandomPurpose::position, 0);
  for (const double spread : {1.0, 1.7, 1000.0, 1e12}) { // ids a particle
    std::vector<std::uint64_t> ids(3000);
    for (std::size_t k = 0; k < ids.size(); ++k)
      ids[k] = 17 + static_cast<std::uint64_t>(spread * static_cast<double>(k)); // all different
    for (std::size_t k = ids.size() - 1; k > 0; --k)
      std::swap(ids[k], ids[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
    CHECK(order_by_id(ids) == twin(ids));
  }
}

} // namespace order_test
