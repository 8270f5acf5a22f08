// Kernels for AVX-512: registers of 64 bytes. Compiled with -mavx512f.
#include "far_kernels.hpp"
#include "kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx512
#define KEELER_LANES 8

namespace {

typedef double Lanes __attribute__((vector_size(64), may_alias));
typedef long long Longs __attribute__((vector_size(64), may_alias));
typedef float Floats __attribute__((vector_size(64), may_alias));
typedef int Ints __attribute__((vector_size(64), may_alias));

// The masks select all lanes; gcc 12 warns falsely about the plain forms.
inline Lanes larger(const Lanes& a, const Lanes& b) {
  return _mm512_maskz_max_pd(0xff, a, b);
}

inline Floats larger(const Floats& a, const Floats& b) {
  return _mm512_maskz_max_ps(0xffff, a, b);
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
