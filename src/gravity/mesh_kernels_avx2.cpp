// The mesh solver's kernels for AVX2: eight lanes. Compiled with -mavx2.
#include "mesh_kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE mesh_avx2
#define KEELER_LANES 8

namespace {

typedef float Lanes __attribute__((vector_size(32), may_alias));
typedef float LanesInRow __attribute__((vector_size(32), aligned(4), may_alias));
typedef int IntLanes __attribute__((vector_size(32), may_alias));

constexpr IntLanes lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline Lanes difference(const double* from, double origin) {
  const __m256d shift = _mm256_set1_pd(origin);
  const __m128 low = _mm256_cvtpd_ps(_mm256_loadu_pd(from) - shift);
  const __m128 high = _mm256_cvtpd_ps(_mm256_loadu_pd(from + 4) - shift);
  return _mm256_set_m128(high, low);
}

inline void append(keeler::NearSources& s, const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& mass,
                   const IntLanes& inside) {
  int mask = _mm256_movemask_ps(reinterpret_cast<const __m256&>(inside));
  for (; mask != 0; mask &= mask - 1) {
    const int lane = __builtin_ctz(static_cast<unsigned>(mask));
    s.x[s.count] = x[lane];
    s.y[s.count] = y[lane];
    s.z[s.count] = z[lane];
    s.mass[s.count] = mass[lane];
    ++s.count;
  }
}

} // namespace

#include "mesh_kernels.inl"
