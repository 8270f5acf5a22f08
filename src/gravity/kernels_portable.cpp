// Kernels for any processor: registers of 16 bytes, which both x86-64 (SSE2) and 64-bit ARM have.
#include "far_kernels.hpp"
#include "kernels.hpp"

#define KEELER_KERNEL_SPACE kernels_portable
#define KEELER_LANES 2

namespace {

typedef double Lanes __attribute__((vector_size(16), may_alias));
typedef long long Longs __attribute__((vector_size(16), may_alias));
typedef float Floats __attribute__((vector_size(16), may_alias));
typedef int Ints __attribute__((vector_size(16), may_alias));

inline Lanes larger(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}

inline Floats larger(const Floats& a, const Floats& b) {
  return a > b ? a : b;
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
