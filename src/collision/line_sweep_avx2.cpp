// Lines for AVX2: eight lanes. Compiled with -mavx2.
#include "line_sweep.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE line_sweep_avx2

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 8;
typedef float Floats __attribute__((vector_size(32)));
typedef std::int32_t Integers __attribute__((vector_size(32)));
typedef std::uint32_t Unsigned __attribute__((vector_size(32)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

// Eight lines of eight numbers, transposed.
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

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
