// The mesh solver's kernels for any processor: four lanes, which both x86-64 (SSE2) and 64-bit ARM have.
#include "mesh_kernels.hpp"

#define KEELER_KERNEL_SPACE mesh_portable
#define KEELER_LANES 4

namespace {

typedef float Lanes __attribute__((vector_size(16), may_alias));
typedef float LanesInRow __attribute__((vector_size(16), aligned(4), may_alias));
typedef int IntLanes __attribute__((vector_size(16), may_alias));

// Four values of one row, and of four consecutive rows.
typedef float Four __attribute__((vector_size(16), may_alias));
typedef float FourInRow __attribute__((vector_size(16), aligned(4), may_alias));
struct Sixteen {
  Lanes part[16 / KEELER_LANES];
};

constexpr IntLanes lane_numbers = {0, 1, 2, 3};

inline Lanes difference(const double* from, double origin) {
  return Lanes{static_cast<float>(from[0] - origin), static_cast<float>(from[1] - origin),
               static_cast<float>(from[2] - origin), static_cast<float>(from[3] - origin)};
}

inline std::size_t append(keeler::gravity::NearSources& s, std::size_t count, const Lanes& x, const Lanes& y,
                          const Lanes& z, const Lanes& mass, const IntLanes& inside) {
  for (int lane = 0; lane < KEELER_LANES; ++lane) {
    s.x[count] = x[lane];
    s.y[count] = y[lane];
    s.z[count] = z[lane];
    s.mass[count] = mass[lane];
    count += inside[lane] != 0;
  }
  return count;
}

inline Sixteen rows(const float* from, std::size_t stride) {
  Sixteen result;
  for (std::size_t r = 0; r < 4; ++r)
    result.part[r] = *reinterpret_cast<const FourInRow*>(from + r * stride);
  return result;
}

inline void put_rows(float* to, std::size_t stride, const Sixteen& value) {
  for (std::size_t r = 0; r < 4; ++r)
    *reinterpret_cast<FourInRow*>(to + r * stride) = value.part[r];
}

inline Sixteen each_row(const Four& value) {
  Sixteen result;
  for (int r = 0; r < 4; ++r)
    result.part[r] = Lanes{value[r], value[r], value[r], value[r]};
  return result;
}

inline Sixteen all_rows(const Four& value) {
  return {{value, value, value, value}};
}

inline Four rows_sum(const Sixteen& value) {
  return (value.part[0] + value.part[2]) + (value.part[1] + value.part[3]);
}

} // namespace

#include "mesh_kernels.inl"
