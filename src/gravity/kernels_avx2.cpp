// Kernels for AVX2: four lanes. Compiled with -mavx2.
#include <keeler/gravity/far_kernels.hpp>
#include <keeler/gravity/kernels.hpp>

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx2
#define KEELER_LANES 4

namespace {

typedef double Lanes __attribute__((vector_size(32), may_alias));

inline Lanes square_root(const Lanes& value) {
  return _mm256_sqrt_pd(value);
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
