#include <keeler/core/memory.hpp>

#include <keeler/core/error.hpp>

#include "draws.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace memory_test {

using namespace keeler;

struct Faults {
  long first, second;
};

// Returns the page faults of two arrays that are filled one after the other, in a process with this policy.
Faults faults_of_arrays(void (*set_policy)()) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    set_policy();
    long counts[3] = {};
    for (long& count : counts) {
      rusage used{};
      getrusage(RUSAGE_SELF, &used);
      count = used.ru_minflt;
      const std::vector<char> array(std::size_t{100} << 20, 1);
    }
    const Faults faults{counts[1] - counts[0], counts[2] - counts[1]};
    _exit(write(ends[1], &faults, sizeof faults) == sizeof faults ? 0 : 1);
  }
  Faults faults{};
  CHECK(read(ends[0], &faults, sizeof faults) == sizeof faults);
  waitpid(child, nullptr, 0);
  close(ends[0]);
  close(ends[1]);
  return faults;
}

#ifdef __GLIBC__
TEST_CASE("an array in kept memory costs no page faults, one in returned memory as many as before") {
  if (test::sanitized || std::getenv("GLIBC_TUNABLES") || std::getenv("MALLOC_MMAP_THRESHOLD_") ||
      std::getenv("MALLOC_MMAP_MAX_") || std::getenv("MALLOC_TRIM_THRESHOLD_") || std::getenv("MALLOC_TOP_PAD_"))
    return; // another allocator, or another policy
  const Faults kept = faults_of_arrays(keep_freed_memory), returned = faults_of_arrays(return_freed_memory);
  CHECK(kept.first > 20); // of 2 MB at most
  CHECK(kept.second <= kept.first / 10);
  CHECK(returned.second >= returned.first / 2);
}
#endif

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
