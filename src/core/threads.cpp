#include <keeler/core/threads.hpp>

#include <omp.h>

namespace keeler {

void set_threads(int count) {
  omp_set_num_threads(std::max(1, count));
}

int threads() {
  return omp_get_max_threads();
}

} // namespace keeler
