#include "kernels.hpp"

#include "ablation.hpp"

namespace keeler::collision {

namespace kernels_portable {
extern const Kernels table;
}
#if defined(__x86_64__)
namespace kernels_avx2 {
extern const Kernels table;
}
namespace kernels_avx512 {
extern const Kernels table;
}

namespace {

// Up to this length of a range or list, eight lanes are faster than sixteen; most are that short.
constexpr std::size_t few = 8;

std::size_t sweep(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                  const std::uint32_t* indices, std::size_t count, std::uint32_t* kept) {
  const LineSweep by = count > few ? kernels_avx512::table.sweep : kernels_avx2::table.sweep;
  return by(line, lines, frame, span, indices, count, kept);
}

std::size_t sweep_group(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                        const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found) {
  const LineGroupSweep by = end - begin > few ? kernels_avx512::table.sweep_group : kernels_avx2::table.sweep_group;
  return by(lines, first, last, frame, span, begin, end, found);
}

} // namespace
#endif

Kernels kernels([[maybe_unused]] InstructionSet set) {
  if (without(Acceleration::simd))
    return kernels_portable::table;
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return {sweep, sweep_group, kernels_avx512::table.filter, kernels_avx512::table.follow};
  if (set == InstructionSet::avx2)
    return kernels_avx2::table;
#endif
  return kernels_portable::table;
}

} // namespace keeler::collision
