// The kernels for AVX-512, with sixteen lanes. Compiled with -mavx512f.
#include "kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx512

namespace keeler::collision::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 16;
typedef float Floats __attribute__((vector_size(64)));
typedef std::int32_t Integers __attribute__((vector_size(64)));
typedef std::uint32_t Unsigned __attribute__((vector_size(64)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

// Loads sixteen lines of eight numbers and transposes them: line k beside line k + 8 in one register, then eight lines
// per half.
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
  // r[k] holds fields k and k + 4 of lines 0-3 or, for k >= 4, of lines 4-7, and of the lines eight further on
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

constexpr std::size_t halves = 8;
typedef double Doubles __attribute__((vector_size(64)));
typedef std::int64_t Longs __attribute__((vector_size(64)));
typedef float Singles __attribute__((vector_size(32)));
typedef std::int32_t Words __attribute__((vector_size(32)));

inline unsigned nonzero(const Longs& mask) {
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask));
}

// Loads eight rows of eight numbers and transposes them.
inline void load_bodies(const double* rows, Doubles fields[8]) {
  __m512d r[8], t[8];
  for (int k = 0; k < 8; ++k)
    r[k] = _mm512_loadu_pd(rows + 8 * k);
  for (int k = 0; k < 8; k += 2) {
    t[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
    t[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
  }
  for (int odd = 0; odd < 2; ++odd) { // fields odd, odd + 2, odd + 4 and odd + 6
    const __m512d a = _mm512_shuffle_f64x2(t[odd], t[2 + odd], 0x88);
    const __m512d b = _mm512_shuffle_f64x2(t[4 + odd], t[6 + odd], 0x88);
    const __m512d c = _mm512_shuffle_f64x2(t[odd], t[2 + odd], 0xdd);
    const __m512d d = _mm512_shuffle_f64x2(t[4 + odd], t[6 + odd], 0xdd);
    fields[odd] = _mm512_shuffle_f64x2(a, b, 0x88);
    fields[odd + 4] = _mm512_shuffle_f64x2(a, b, 0xdd);
    fields[odd + 2] = _mm512_shuffle_f64x2(c, d, 0x88);
    fields[odd + 6] = _mm512_shuffle_f64x2(c, d, 0xdd);
  }
}

struct HalfFields {
  Words x, y;
  Singles z, u, v, w, size;
};

// Transposes eight rows of eight numbers of 32 bits.
inline void transpose(__m256 r[8]) {
  __m256 t[8];
  for (int k = 0; k < 8; k += 2) {
    t[k] = _mm256_unpacklo_ps(r[k], r[k + 1]);
    t[k + 1] = _mm256_unpackhi_ps(r[k], r[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    r[k] = _mm256_shuffle_ps(t[k], t[k + 2], 0x44);
    r[k + 1] = _mm256_shuffle_ps(t[k], t[k + 2], 0xee);
    r[k + 2] = _mm256_shuffle_ps(t[k + 1], t[k + 3], 0x44);
    r[k + 3] = _mm256_shuffle_ps(t[k + 1], t[k + 3], 0xee);
  }
  for (int k = 0; k < 4; ++k) {
    t[k] = _mm256_permute2f128_ps(r[k], r[k + 4], 0x20);
    t[k + 4] = _mm256_permute2f128_ps(r[k], r[k + 4], 0x31);
  }
  for (int k = 0; k < 8; ++k)
    r[k] = t[k];
}

inline HalfFields load_half(const Line* lines) {
  __m256 r[8];
  for (int k = 0; k < 8; ++k)
    r[k] = _mm256_load_ps(reinterpret_cast<const float*>(lines + k));
  transpose(r);
  return {reinterpret_cast<Words>(r[0]), reinterpret_cast<Words>(r[1]), r[2], r[3], r[4], r[5], r[6]};
}

inline void store_lines(Line* lines, const Words& x, const Words& y, const Singles& z, const Singles& u,
                        const Singles& v, const Singles& w, const Singles& size, const Words& tag) {
  __m256 r[8] = {reinterpret_cast<__m256>(x),  reinterpret_cast<__m256>(y), z, u, v, w, size,
                 reinterpret_cast<__m256>(tag)};
  transpose(r);
  for (int k = 0; k < 8; ++k)
    _mm256_store_ps(reinterpret_cast<float*>(lines + k), r[k]);
}

} // namespace
} // namespace keeler::collision::KEELER_KERNEL_SPACE

#include "kernels.inl"
