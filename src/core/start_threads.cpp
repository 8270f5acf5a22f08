#include <keeler/core/start_threads.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace keeler {

// First starts as many system threads, all alive at once, because their failure can be caught; then OpenMP's.
void start_threads() {
  std::latch all_there(1);
  std::vector<std::jthread> trials;
  const auto end_trials = [&] {
    all_there.count_down();
    trials.clear();
  };
  try {
    for (int k = 1; k < threads(); ++k)
      trials.emplace_back([&] { all_there.wait(); });
  } catch (const std::system_error& error) {
    end_trials();
    throw Error(ExitCode::run_time,
                fmt::format("the system cannot start {} threads ({}); request fewer by --threads or OMP_NUM_THREADS, "
                            "or raise the limit on memory or processes",
                            threads(), error.code().message()));
  }
  end_trials();
#pragma omp parallel
  {}
}

} // namespace keeler
