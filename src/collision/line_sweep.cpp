#include <keeler/collision/line_sweep.hpp>

namespace keeler {

namespace line_sweep_portable {
extern const LineSweep sweep;
}
#if defined(__x86_64__)
namespace line_sweep_avx2 {
extern const LineSweep sweep;
}
namespace line_sweep_avx512 {
extern const LineSweep sweep;
}
#endif

LineSweep line_sweep([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return line_sweep_avx512::sweep;
  if (set == InstructionSet::avx2)
    return line_sweep_avx2::sweep;
#endif
  return line_sweep_portable::sweep;
}

} // namespace keeler
