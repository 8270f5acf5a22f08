// The mesh solver's kernels for AVX-512: sixteen lanes. Compiled with -mavx512f.
#include "mesh_kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE mesh_avx512
#define KEELER_LANES 16

namespace {

typedef float Lanes __attribute__((vector_size(64), may_alias));
typedef float LanesInRow __attribute__((vector_size(64), aligned(4), may_alias));
typedef int IntLanes __attribute__((vector_size(64), may_alias));

// Four values of one row, and of four consecutive rows.
typedef float Four __attribute__((vector_size(16), may_alias));
typedef float FourInRow __attribute__((vector_size(16), aligned(4), may_alias));
struct Sixteen {
  Lanes part[16 / KEELER_LANES];
};

constexpr IntLanes lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

inline Lanes difference(const double* from, double origin) {
  const __m512d shift = _mm512_set1_pd(origin);
  // The masks select all lanes; gcc 12 warns falsely about the plain forms
  const __m256 low = _mm512_maskz_cvtpd_ps(0xff, _mm512_loadu_pd(from) - shift);
  const __m256 high = _mm512_maskz_cvtpd_ps(0xff, _mm512_loadu_pd(from + 8) - shift);
  const __m512d lower = _mm512_maskz_broadcast_f64x4(0xff, _mm256_castps_pd(low));
  return _mm512_castpd_ps(_mm512_mask_broadcast_f64x4(lower, 0xf0, _mm256_castps_pd(high)));
}

inline std::size_t append(keeler::gravity::NearSources& s, std::size_t count, const Lanes& x, const Lanes& y,
                          const Lanes& z, const Lanes& mass, const IntLanes& inside) {
  const __mmask16 mask = _mm512_test_epi32_mask(reinterpret_cast<const __m512i&>(inside), _mm512_set1_epi32(-1));
  _mm512_storeu_ps(s.x + count, _mm512_maskz_compress_ps(mask, x));
  _mm512_storeu_ps(s.y + count, _mm512_maskz_compress_ps(mask, y));
  _mm512_storeu_ps(s.z + count, _mm512_maskz_compress_ps(mask, z));
  _mm512_storeu_ps(s.mass + count, _mm512_maskz_compress_ps(mask, mass));
  return count + static_cast<std::size_t>(__builtin_popcount(mask));
}

inline Sixteen rows(const float* from, std::size_t stride) {
  __m512 result = _mm512_castps128_ps512(_mm_loadu_ps(from));
  result = _mm512_maskz_insertf32x4(0xffff, result, _mm_loadu_ps(from + stride), 1);
  result = _mm512_maskz_insertf32x4(0xffff, result, _mm_loadu_ps(from + 2 * stride), 2);
  return {{_mm512_maskz_insertf32x4(0xffff, result, _mm_loadu_ps(from + 3 * stride), 3)}};
}

inline void put_rows(float* to, std::size_t stride, const Sixteen& value) {
  _mm_storeu_ps(to, _mm512_maskz_extractf32x4_ps(0xf, value.part[0], 0));
  _mm_storeu_ps(to + stride, _mm512_maskz_extractf32x4_ps(0xf, value.part[0], 1));
  _mm_storeu_ps(to + 2 * stride, _mm512_maskz_extractf32x4_ps(0xf, value.part[0], 2));
  _mm_storeu_ps(to + 3 * stride, _mm512_maskz_extractf32x4_ps(0xf, value.part[0], 3));
}

inline Sixteen each_row(const Four& value) {
  const __m512i rows_of_lanes = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  return {{_mm512_maskz_permutexvar_ps(0xffff, rows_of_lanes, _mm512_castps128_ps512(value))}};
}

inline Sixteen all_rows(const Four& value) {
  return {{_mm512_maskz_broadcast_f32x4(0xffff, value)}};
}

inline Four rows_sum(const Sixteen& value) {
  const Lanes& rows = value.part[0];
  return (_mm512_maskz_extractf32x4_ps(0xf, rows, 0) + _mm512_maskz_extractf32x4_ps(0xf, rows, 2)) +
         (_mm512_maskz_extractf32x4_ps(0xf, rows, 1) + _mm512_maskz_extractf32x4_ps(0xf, rows, 3));
}

} // namespace

#include "mesh_kernels.inl"
