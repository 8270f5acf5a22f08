// Lines for AVX2: eight lanes. Compiled with -mavx2.
#include <keeler/collision/line_sweep.hpp>

#include <immintrin.h>

#define KEELER_KERNEL_SPACE line_sweep_avx2

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 8;
typedef float Floats __attribute__((vector_size(32)));
typedef std::int32_t Integers __attribute__((vector_size(32)));
typedef std::uint32_t Unsigned __attribute__((vector_size(32)));

inline unsigned nonzero(const Integers& mask) {
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
}

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
