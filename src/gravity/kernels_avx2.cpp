// Kernels for AVX2: registers of 32 bytes. Compiled with -mavx2.
#include "far_kernels.hpp"
#include "kernels.hpp"

#include <immintrin.h>

#define KEELER_KERNEL_SPACE kernels_avx2
#define KEELER_LANES 4

namespace {

typedef double Lanes __attribute__((vector_size(32), may_alias));
typedef long long Longs __attribute__((vector_size(32), may_alias));
typedef float Floats __attribute__((vector_size(32), may_alias));
typedef int Ints __attribute__((vector_size(32), may_alias));

inline Lanes larger(const Lanes& a, const Lanes& b) {
  return _mm256_max_pd(a, b);
}

inline Floats larger(const Floats& a, const Floats& b) {
  return _mm256_max_ps(a, b);
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
