#include "monotone_newton.hpp"

namespace keeler::finders {

namespace monotone_newton_portable {
extern const MonotoneNewton kernel;
}
#if defined(__x86_64__)
namespace monotone_newton_avx2 {
extern const MonotoneNewton kernel;
}
namespace monotone_newton_avx512 {
extern const MonotoneNewton kernel;
}
#endif

MonotoneNewton monotone_newton([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return monotone_newton_avx512::kernel;
  if (set == InstructionSet::avx2)
    return monotone_newton_avx2::kernel;
#endif
  return monotone_newton_portable::kernel;
}

} // namespace keeler::finders
