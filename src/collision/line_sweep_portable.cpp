// Lines for any processor: four lanes.
#include <keeler/collision/line_sweep.hpp>

#define KEELER_KERNEL_SPACE line_sweep_portable

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 4;
typedef float Floats __attribute__((vector_size(16)));
typedef std::int32_t Integers __attribute__((vector_size(16)));
typedef std::uint32_t Unsigned __attribute__((vector_size(16)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

inline Fields load(const Line* from) {
  Fields f;
  for (std::size_t k = 0; k < lanes; ++k) {
    f.x[k] = from[k].x, f.y[k] = from[k].y, f.z[k] = from[k].z;
    f.u[k] = from[k].u, f.v[k] = from[k].v, f.w[k] = from[k].w;
    f.size[k] = from[k].size;
  }
  return f;
}

inline unsigned nonzero(const Integers& mask) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < lanes; ++k)
    bits |= static_cast<unsigned>(mask[k] != 0) << k;
  return bits;
}

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
