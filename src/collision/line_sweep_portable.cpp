// Lines for any processor: four lanes.
#include "line_sweep.hpp"

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

template<class LineAt> inline Fields load(const LineAt& line_at) {
  Fields f;
  for (std::size_t k = 0; k < lanes; ++k) {
    const Line& line = *line_at(k);
    f.x[k] = line.x, f.y[k] = line.y, f.z[k] = line.z;
    f.u[k] = line.u, f.v[k] = line.v, f.w[k] = line.w;
    f.size[k] = line.size;
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
