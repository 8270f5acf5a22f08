// The kernels for AVX2, with eight lanes. Compiled with -mavx2.
#include "kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx2

namespace keeler::collision::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 8;
typedef float Floats __attribute__((vector_size(32)));
typedef std::int32_t Integers __attribute__((vector_size(32)));
typedef std::uint32_t Unsigned __attribute__((vector_size(32)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

// Loads eight lines of eight numbers and transposes them.
template<class LineAt> inline Fields load(const LineAt& line_at) {
  __m256 r[8], t[8];
  for (std::size_t k = 0; k < 8; ++k)
    r[k] = _mm256_load_ps(reinterpret_cast<const float*>(line_at(k)));
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
  return {reinterpret_cast<Integers>(_mm256_permute2f128_ps(r[0], r[4], 0x20)),
          reinterpret_cast<Integers>(_mm256_permute2f128_ps(r[1], r[5], 0x20)),
          _mm256_permute2f128_ps(r[2], r[6], 0x20),
          _mm256_permute2f128_ps(r[3], r[7], 0x20),
          _mm256_permute2f128_ps(r[0], r[4], 0x31),
          _mm256_permute2f128_ps(r[1], r[5], 0x31),
          _mm256_permute2f128_ps(r[2], r[6], 0x31)};
}

inline unsigned nonzero(const Integers& mask) {
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
}

constexpr std::size_t halves = 4;
typedef double Doubles __attribute__((vector_size(32)));
typedef std::int64_t Longs __attribute__((vector_size(32)));
typedef float Singles __attribute__((vector_size(16)));
typedef std::int32_t Words __attribute__((vector_size(16)));

inline unsigned nonzero(const Longs& mask) {
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
}

// Loads four rows of eight numbers and transposes them by halves.
inline void load_bodies(const double* rows, Doubles fields[8]) {
  for (int half = 0; half < 8; half += 4) {
    __m256d r[4];
    for (int k = 0; k < 4; ++k)
      r[k] = _mm256_loadu_pd(rows + 8 * k + half);
    const __m256d a = _mm256_unpacklo_pd(r[0], r[1]), b = _mm256_unpackhi_pd(r[0], r[1]);
    const __m256d c = _mm256_unpacklo_pd(r[2], r[3]), d = _mm256_unpackhi_pd(r[2], r[3]);
    fields[half] = _mm256_permute2f128_pd(a, c, 0x20);
    fields[half + 1] = _mm256_permute2f128_pd(b, d, 0x20);
    fields[half + 2] = _mm256_permute2f128_pd(a, c, 0x31);
    fields[half + 3] = _mm256_permute2f128_pd(b, d, 0x31);
  }
}

struct HalfFields {
  Words x, y;
  Singles z, u, v, w, size;
};

inline HalfFields load_half(const Line* lines) {
  __m128 first[4], second[4];
  for (int k = 0; k < 4; ++k) {
    first[k] = _mm_load_ps(reinterpret_cast<const float*>(lines + k));
    second[k] = _mm_load_ps(reinterpret_cast<const float*>(lines + k) + 4);
  }
  _MM_TRANSPOSE4_PS(first[0], first[1], first[2], first[3]);
  _MM_TRANSPOSE4_PS(second[0], second[1], second[2], second[3]);
  return {reinterpret_cast<Words>(first[0]),
          reinterpret_cast<Words>(first[1]),
          first[2],
          first[3],
          second[0],
          second[1],
          second[2]};
}

inline void store_lines(Line* lines, const Words& x, const Words& y, const Singles& z, const Singles& u,
                        const Singles& v, const Singles& w, const Singles& size, const Words& tag) {
  __m128 first[4] = {reinterpret_cast<__m128>(x), reinterpret_cast<__m128>(y), z, u},
         second[4] = {v, w, size, reinterpret_cast<__m128>(tag)};
  _MM_TRANSPOSE4_PS(first[0], first[1], first[2], first[3]);
  _MM_TRANSPOSE4_PS(second[0], second[1], second[2], second[3]);
  for (int k = 0; k < 4; ++k) {
    _mm_store_ps(reinterpret_cast<float*>(lines + k), first[k]);
    _mm_store_ps(reinterpret_cast<float*>(lines + k) + 4, second[k]);
  }
}

} // namespace
} // namespace keeler::collision::KEELER_KERNEL_SPACE

#include "kernels.inl"
