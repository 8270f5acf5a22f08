// Lines for AVX-512: sixteen lanes. Compiled with -mavx512f.
#include <keeler/collision/line_sweep.hpp>

#include <immintrin.h>

#define KEELER_KERNEL_SPACE line_sweep_avx512

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 16;
typedef float Floats __attribute__((vector_size(64)));
typedef std::int32_t Integers __attribute__((vector_size(64)));
typedef std::uint32_t Unsigned __attribute__((vector_size(64)));

inline unsigned nonzero(const Integers& mask) {
  return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask));
}

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
