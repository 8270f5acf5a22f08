// The mesh solver's kernels for any processor: four lanes, which is what x86-64 (SSE2) and 64-bit ARM both have.
#include "mesh_kernels.hpp"

#define KEELER_KERNEL_SPACE mesh_portable
#define KEELER_LANES 4

namespace {

typedef float Lanes __attribute__((vector_size(16), may_alias));
typedef float LanesInRow __attribute__((vector_size(16), aligned(4), may_alias));
typedef int IntLanes __attribute__((vector_size(16), may_alias));

constexpr IntLanes lane_numbers = {0, 1, 2, 3};

inline Lanes difference(const double* from, double origin) {
  return Lanes{static_cast<float>(from[0] - origin), static_cast<float>(from[1] - origin),
               static_cast<float>(from[2] - origin), static_cast<float>(from[3] - origin)};
}

inline void append(keeler::NearSources& s, const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& mass,
                   const IntLanes& inside) {
  for (int lane = 0; lane < KEELER_LANES; ++lane) {
    s.x[s.count] = x[lane];
    s.y[s.count] = y[lane];
    s.z[s.count] = z[lane];
    s.mass[s.count] = mass[lane];
    s.count += inside[lane] != 0;
  }
}

} // namespace

#include "mesh_kernels.inl"
