#include <keeler/core/memory.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace memory_test {

using namespace keeler;

TEST_CASE("the peak of memory grows with allocations and does not decrease") {
  constexpr std::size_t bytes = 200'000'000;
  const double before = peak_memory();
  {
    const std::vector<char> held(bytes, 1);
    CHECK(held.back() == 1);
  }
  const double after = peak_memory();
  CHECK(before > 0.0);
  CHECK(after >= bytes);
  CHECK(after >= before);
}

TEST_CASE("counts are checked before they become sizes") {
  CHECK(available_memory() > 1e6);
  CHECK(available_memory() <= 0x1p47);
  CHECK(affordable_size(0.0, 8.0, "nothing", "") == 0);
  CHECK(affordable_size(1000.9, 8.0, "some", "") == 1000);
  for (const double count : {1e18, 1e300, HUGE_VAL, -HUGE_VAL, std::nan(""), 2.0 * available_memory() / 8.0})
    CHECK_THROWS_AS(affordable_size(count, 8.0, "a mesh", "make it coarser"), UsageError);
  CHECK_THROWS_AS(affordable_size(-1.0, 8.0, "a mesh", ""), UsageError);
  CHECK_THROWS_AS(affordable_size(0x1p60, 0.0, "a mesh", ""), UsageError); // of nothing, and no index has so many
  CHECK_THROWS_WITH_AS(require_memory(1e20, "a mesh", "make it coarser"),
                       doctest::Contains("a mesh needs 1e11 GB of memory, and "), UsageError);
  require_memory(1.0, "a byte", "");
}

} // namespace memory_test
