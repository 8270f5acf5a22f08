// Threads. Every result is the same, bit for bit, for any number of them: loops give each index to exactly one thread,
// and sums are made in an order that depends on the length alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace keeler {

/// How many threads loops use from now on (at least 1). The default is what OpenMP offers.
void set_threads(int count);
int threads();

/// Calls body(k) once for each k in [0, count), in no promised order; body must write only what belongs to k.
/// Exceptions must not leave body. What fits in one chunk runs on the calling thread.
template<class Body> void parallel_for(std::size_t count, const Body& body, int chunk = 256) {
#pragma omp parallel for schedule(dynamic, chunk) if (count > static_cast <std::size_t>(chunk))
  for (std::size_t k = 0; k < count; ++k)
    body(k);
}

/// Sum of term(k) over [0, count): blocks of fixed length, added in order, so the bits do not depend on the threads.
template<class Term> double ordered_sum(std::size_t count, const Term& term) {
  constexpr std::size_t block = 1024;
  std::vector<double> sums((count + block - 1) / block, 0.0);
  parallel_for(
      sums.size(),
      [&](std::size_t b) {
        double sum = 0.0;
        for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
          sum += term(k);
        sums[b] = sum;
      },
      1);
  double total = 0.0;
  for (const double sum : sums)
    total += sum;
  return total;
}

} // namespace keeler
