// The mesh solver's kernels for AVX2: eight lanes. Compiled with -mavx2.
#include "mesh_kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE mesh_avx2
#define KEELER_LANES 8

namespace {

typedef float Lanes __attribute__((vector_size(32), may_alias));
typedef float LanesInRow __attribute__((vector_size(32), aligned(4), may_alias));
typedef int IntLanes __attribute__((vector_size(32), may_alias));

// Four values of one row, and of four consecutive rows.
typedef float Four __attribute__((vector_size(16), may_alias));
typedef float FourInRow __attribute__((vector_size(16), aligned(4), may_alias));
struct Sixteen {
  Lanes part[16 / KEELER_LANES];
};

constexpr IntLanes lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline Lanes difference(const double* from, double origin) {
  const __m256d shift = _mm256_set1_pd(origin);
  const __m128 low = _mm256_cvtpd_ps(_mm256_loadu_pd(from) - shift);
  const __m128 high = _mm256_cvtpd_ps(_mm256_loadu_pd(from + 4) - shift);
  return _mm256_set_m128(high, low);
}

inline std::size_t append(keeler::gravity::NearSources& s, std::size_t count, const Lanes& x, const Lanes& y,
                          const Lanes& z, const Lanes& mass, const IntLanes& inside) {
  int mask = _mm256_movemask_ps(reinterpret_cast<const __m256&>(inside));
  for (; mask != 0; mask &= mask - 1) {
    const int lane = __builtin_ctz(static_cast<unsigned>(mask));
    s.x[count] = x[lane];
    s.y[count] = y[lane];
    s.z[count] = z[lane];
    s.mass[count] = mass[lane];
    ++count;
  }
  return count;
}

inline Sixteen rows(const float* from, std::size_t stride) {
  return {{_mm256_loadu2_m128(from + stride, from), _mm256_loadu2_m128(from + 3 * stride, from + 2 * stride)}};
}

inline void put_rows(float* to, std::size_t stride, const Sixteen& value) {
  _mm256_storeu2_m128(to + stride, to, value.part[0]);
  _mm256_storeu2_m128(to + 3 * stride, to + 2 * stride, value.part[1]);
}

inline Sixteen each_row(const Four& value) {
  const __m256 twice = _mm256_set_m128(value, value);
  return {{_mm256_permutevar8x32_ps(twice, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1)),
           _mm256_permutevar8x32_ps(twice, _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3))}};
}

inline Sixteen all_rows(const Four& value) {
  return {{_mm256_set_m128(value, value), _mm256_set_m128(value, value)}};
}

inline Four rows_sum(const Sixteen& value) {
  const __m256 halves = value.part[0] + value.part[1];
  return _mm256_castps256_ps128(halves) + _mm256_extractf128_ps(halves, 1);
}

} // namespace

#include "mesh_kernels.inl"
