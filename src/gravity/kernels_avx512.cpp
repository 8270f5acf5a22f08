// Kernels for AVX-512: eight lanes. Compiled with -mavx512f.
#include <keeler/gravity/far_kernels.hpp>
#include <keeler/gravity/kernels.hpp>

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx512
#define KEELER_LANES 8

namespace {

typedef double Lanes __attribute__((vector_size(64), may_alias));

inline Lanes square_root(const Lanes& value) {
  return _mm512_maskz_sqrt_pd(0xff, value); // all lanes; gcc 12 warns falsely at the plain form
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
