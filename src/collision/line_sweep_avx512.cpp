// Lines for AVX-512: sixteen lanes. Compiled with -mavx512f.
#include "line_sweep.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE line_sweep_avx512

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 16;
typedef float Floats __attribute__((vector_size(64)));
typedef std::int32_t Integers __attribute__((vector_size(64)));
typedef std::uint32_t Unsigned __attribute__((vector_size(64)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

// Sixteen lines of eight numbers, transposed: line k beside line k + 8 in one register, then as eight lines of each
// half.
template<class LineAt> inline Fields load(const LineAt& line_at) {
  __m512 r[8], t[8];
  for (std::size_t k = 0; k < 8; ++k) {
    const __m512d low = _mm512_castpd256_pd512(_mm256_load_pd(reinterpret_cast<const double*>(line_at(k))));
    const __m256d high = _mm256_load_pd(reinterpret_cast<const double*>(line_at(k + 8)));
    r[k] = _mm512_castpd_ps(_mm512_insertf64x4(low, high, 1));
  }
  for (int k = 0; k < 8; k += 2) {
    t[k] = _mm512_unpacklo_ps(r[k], r[k + 1]);
    t[k + 1] = _mm512_unpackhi_ps(r[k], r[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    r[k] = _mm512_shuffle_ps(t[k], t[k + 2], 0x44);
    r[k + 1] = _mm512_shuffle_ps(t[k], t[k + 2], 0xee);
    r[k + 2] = _mm512_shuffle_ps(t[k + 1], t[k + 3], 0x44);
    r[k + 3] = _mm512_shuffle_ps(t[k + 1], t[k + 3], 0xee);
  }
  // r[k] holds fields k and k + 4 of lines 0-3 or, from k = 4 on, 4-7; then of those eight lines on
  const __m512i first = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 8, 9, 10, 11, 24, 25, 26, 27);
  const __m512i second = _mm512_setr_epi32(4, 5, 6, 7, 20, 21, 22, 23, 12, 13, 14, 15, 28, 29, 30, 31);
  return {reinterpret_cast<Integers>(_mm512_permutex2var_ps(r[0], first, r[4])),
          reinterpret_cast<Integers>(_mm512_permutex2var_ps(r[1], first, r[5])),
          _mm512_permutex2var_ps(r[2], first, r[6]),
          _mm512_permutex2var_ps(r[3], first, r[7]),
          _mm512_permutex2var_ps(r[0], second, r[4]),
          _mm512_permutex2var_ps(r[1], second, r[5]),
          _mm512_permutex2var_ps(r[2], second, r[6])};
}

inline unsigned nonzero(const Integers& mask) {
  return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask));
}

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
