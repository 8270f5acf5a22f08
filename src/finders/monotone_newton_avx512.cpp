// The kernel for AVX-512: eight pairs. Compiled with -mavx512f.
#include "monotone_newton.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE monotone_newton_avx512

namespace keeler::finders::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 8;
typedef double Reals __attribute__((vector_size(64)));
typedef decltype(Reals{} < Reals{}) Masks;

struct PairElements {
  Reals guiding_x, guiding_y, e_cos, e_sin, i_sin, i_cos, radius_sum, start;
};

// Transposes eight rows of eight numbers, in place.
inline void transpose(__m512d* row) {
  __m512d t[8];
  for (int k = 0; k < 8; k += 2) {
    t[k] = _mm512_unpacklo_pd(row[k], row[k + 1]);
    t[k + 1] = _mm512_unpackhi_pd(row[k], row[k + 1]);
  }
  for (int k = 0; k < 8; k += 4)
    for (int j = k; j < k + 2; ++j) {
      row[j] = _mm512_shuffle_f64x2(t[j], t[j + 2], 0x88);
      row[j + 2] = _mm512_shuffle_f64x2(t[j], t[j + 2], 0xdd);
    }
  for (int k = 0; k < 4; ++k) {
    t[k] = _mm512_shuffle_f64x2(row[k], row[k + 4], 0x88);
    t[k + 4] = _mm512_shuffle_f64x2(row[k], row[k + 4], 0xdd);
  }
  for (int k = 0; k < 8; ++k)
    row[k] = t[k];
}

inline PairElements load(const MonotonePair* pairs) {
  const __m512i radius_sign = _mm512_setr_epi64(0, 0, 0, 0, 0, 0, static_cast<long long>(1ull << 63), 0);
  __m512d row[8];
  Reals start = {};
  for (std::size_t k = 0; k < lanes; ++k) {
    const __m512d high = _mm512_load_pd(pairs[k].high);
    const __m512d shift = _mm512_zextpd128_pd512(_mm_loadu_pd(pairs[k].query));
    const __m512i low = _mm512_xor_si512(_mm512_load_si512(pairs[k].low), radius_sign); // radii are added
    row[k] = _mm512_sub_pd(_mm512_mask_add_pd(high, 0x3, high, shift), _mm512_castsi512_pd(low));
    start[k] = pairs[k].query[2];
  }
  transpose(row);
  return {row[0], row[1], row[2], row[3], row[4], row[5], row[6], start};
}

inline Reals square_root(Reals a) {
  return _mm512_sqrt_pd(a);
}
inline bool any(Masks mask) {
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask)) != 0;
}
inline double lane(Reals values, std::size_t k) {
  return values[k];
}

} // namespace
} // namespace keeler::finders::KEELER_KERNEL_SPACE

#include "monotone_newton.inl"
