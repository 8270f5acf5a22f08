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

#if defined(__x86_64__)
namespace {

// Most ranges are short: eight lanes are quicker there.
std::size_t sweep_wide(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                       std::size_t begin, std::size_t end, std::uint32_t* found) {
  const LineSweep sweep = end - begin > 8 ? line_sweep_avx512::sweep : line_sweep_avx2::sweep;
  return sweep(line, lines, frame, span, begin, end, found);
}

} // namespace
#endif

LineSweep line_sweep([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return sweep_wide;
  if (set == InstructionSet::avx2)
    return line_sweep_avx2::sweep;
#endif
  return line_sweep_portable::sweep;
}

} // namespace keeler
