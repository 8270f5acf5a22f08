// The kernel for AVX2: four pairs. Compiled with -mavx2.
#include "monotone_newton.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE monotone_newton_avx2

namespace keeler::finders::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 4;
typedef double Reals __attribute__((vector_size(32)));
typedef decltype(Reals{} < Reals{}) Masks;

struct PairElements {
  Reals guiding_x, guiding_y, e_cos, e_sin, i_sin, i_cos, radius_sum, start;
};

// Transposes four rows of four numbers.
inline void transpose(const __m256d* row, Reals* column) {
  const __m256d a = _mm256_unpacklo_pd(row[0], row[1]), b = _mm256_unpackhi_pd(row[0], row[1]);
  const __m256d c = _mm256_unpacklo_pd(row[2], row[3]), d = _mm256_unpackhi_pd(row[2], row[3]);
  column[0] = _mm256_permute2f128_pd(a, c, 0x20);
  column[1] = _mm256_permute2f128_pd(b, d, 0x20);
  column[2] = _mm256_permute2f128_pd(a, c, 0x31);
  column[3] = _mm256_permute2f128_pd(b, d, 0x31);
}

inline PairElements load(const MonotonePair* pairs) {
  const __m256d radius_sign = _mm256_setr_pd(0.0, 0.0, -0.0, 0.0); // negates a radius: radii are added
  __m256d front[4], back[4];
  for (std::size_t k = 0; k < lanes; ++k) {
    const __m256d high = _mm256_load_pd(pairs[k].high);
    const __m256d shifted = _mm256_add_pd(high, _mm256_zextpd128_pd256(_mm_loadu_pd(pairs[k].query)));
    front[k] = _mm256_sub_pd(_mm256_blend_pd(high, shifted, 0x3), _mm256_load_pd(pairs[k].low));
    back[k] =
        _mm256_sub_pd(_mm256_load_pd(pairs[k].high + 4), _mm256_xor_pd(_mm256_load_pd(pairs[k].low + 4), radius_sign));
  }
  Reals column[8];
  transpose(front, column);
  transpose(back, column + 4);
  const Reals start = {pairs[0].query[2], pairs[1].query[2], pairs[2].query[2], pairs[3].query[2]};
  return {column[0], column[1], column[2], column[3], column[4], column[5], column[6], start};
}

inline Reals square_root(Reals a) {
  return _mm256_sqrt_pd(a);
}
inline bool any(Masks mask) {
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
}
inline double lane(Reals values, std::size_t k) {
  return values[k];
}

} // namespace
} // namespace keeler::finders::KEELER_KERNEL_SPACE

#include "monotone_newton.inl"
