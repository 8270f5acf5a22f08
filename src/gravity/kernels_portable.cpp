// Kernels for any processor: two lanes, which is what x86-64 (SSE2) and 64-bit ARM both have.
#include <keeler/gravity/far_kernels.hpp>
#include <keeler/gravity/kernels.hpp>

#define KEELER_KERNEL_SPACE kernels_portable
#define KEELER_LANES 2

namespace {

typedef double Lanes __attribute__((vector_size(16), may_alias));

inline Lanes square_root(const Lanes& value) {
  return Lanes{__builtin_sqrt(value[0]), __builtin_sqrt(value[1])};
}

} // namespace

#include "kernels.inl"

#include "far_kernels.inl"
