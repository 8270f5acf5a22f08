#include "line_sweep.hpp"

namespace keeler {

namespace line_sweep_portable {
extern const LineSweeps sweeps;
}
#if defined(__x86_64__)
namespace line_sweep_avx2 {
extern const LineSweeps sweeps;
}
namespace line_sweep_avx512 {
extern const LineSweeps sweeps;
}
#endif

#if defined(__x86_64__)
namespace {

// Most ranges are short: eight lanes are quicker there.
constexpr std::size_t few = 8;

std::size_t sweep_wide(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                       std::uint32_t* indices, std::size_t count) {
  const LineSweep sweep = count > few ? line_sweep_avx512::sweeps.one : line_sweep_avx2::sweeps.one;
  return sweep(line, lines, frame, span, indices, count);
}

std::size_t sweep_group_wide(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                             const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found) {
  const LineGroupSweep sweep = end - begin > few ? line_sweep_avx512::sweeps.group : line_sweep_avx2::sweeps.group;
  return sweep(lines, first, last, frame, span, begin, end, found);
}

} // namespace
#endif

LineSweeps line_sweeps([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return {sweep_wide, sweep_group_wide};
  if (set == InstructionSet::avx2)
    return line_sweep_avx2::sweeps;
#endif
  return line_sweep_portable::sweeps;
}

} // namespace keeler
