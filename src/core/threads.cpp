#include <keeler/core/threads.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

namespace keeler {

void set_threads(int count) {
  if (count > max_threads)
    throw UsageError(fmt::format("{} threads are requested (by --threads or OMP_NUM_THREADS), and the maximum is {}; "
                                 "request at most the number of processors ({})",
                                 count, max_threads, omp_get_num_procs()));
  omp_set_num_threads(std::max(1, count));
}

int threads() {
  return omp_get_max_threads();
}

} // namespace keeler
