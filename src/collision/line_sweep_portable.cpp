// Lines for any processor: four lanes.
#include <keeler/collision/line_sweep.hpp>

#define KEELER_KERNEL_SPACE line_sweep_portable

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 4;
typedef float Floats __attribute__((vector_size(16)));
typedef std::int32_t Integers __attribute__((vector_size(16)));
typedef std::uint32_t Unsigned __attribute__((vector_size(16)));

inline unsigned nonzero(const Integers& mask) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < lanes; ++k)
    bits |= static_cast<unsigned>(mask[k] != 0) << k;
  return bits;
}

} // namespace
} // namespace keeler::KEELER_KERNEL_SPACE

#include "line_sweep.inl"
