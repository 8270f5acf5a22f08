// Text of the sweep; see line_sweep.hpp. The including file sets KEELER_KERNEL_SPACE and defines the vectors Floats and
// Integers of `lanes` lanes, `Fields load(line_at)`, which turns the lines that line_at(0), line_at(1) and so on point
// to into a vector a field, and `unsigned nonzero(Integers)`, a bit a lane. Everything here has internal linkage except
// `sweeps`.

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

inline Floats floats(const Integers& values) {
  return __builtin_convertvector(values, Floats);
}

// Differences wrap: those of unsigned integers, to be defined in C++.
inline Integers minus(const Integers& a, const Integers& b) {
  return (Integers)((Unsigned)a - (Unsigned)b);
}

// A bit for each line that may touch.
inline unsigned near(const Line& line, const Fields& other, const LineFrame& frame, const LineSpan& span) {
  const Integers x = Integers{} + line.x, y = Integers{} + line.y, offset = Integers{} + frame.offset_y;
  const Integers across = minus(other.x, x);
  // an image one box inward is ahead by the offset, one outward behind: seen by the overflow of the difference
  const Integers outward = ~(across >> 31);
  const Integers wrapped = ((other.x ^ x) & (other.x ^ across)) >> 31;
  const Integers behind = minus(outward, offset ^ outward) & wrapped;
  const Floats dx = frame.metres_x * floats(across);
  const Floats dy = frame.metres_y * floats(minus(minus(other.y, y), behind));
  const Floats dz = other.z - line.z;
  const Floats du = other.u - line.u;
  const Floats dv = other.v - line.v - frame.shear * dx;
  const Floats dw = other.w - line.w;
  const Floats size = other.size + line.size;
  const Floats closing = -(dx * du + dy * dv + dz * dw);
  const Floats first = Floats{} + span.begin, last = Floats{} + span.end;
  Floats time = closing / (du * du + dv * dv + dw * dw + 1e-30f);
  time = time > first ? time : first;
  time = time < last ? time : last;
  const Floats cx = dx + time * du, cy = dy + time * dv, cz = dz + time * dw;
  return nonzero(cx * cx + cy * cy + cz * cz <= size * size);
}

inline std::size_t sweep(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                         std::uint32_t* indices, std::size_t count) {
  if (count == 0)
    return 0;
  for (std::size_t k = 0; k < lanes; ++k)
    indices[count + k] = indices[count - 1];
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; k += lanes) {
    const std::uint32_t* const from = indices + k;
    unsigned bits = near(line, load([&](std::size_t n) { return lines + from[n]; }), frame, span);
    if (k + lanes > count)
      bits &= (1u << (count - k)) - 1u;
    for (; bits; bits &= bits - 1)
      indices[kept++] = from[__builtin_ctz(bits)];
  }
  return kept;
}

inline std::size_t sweep_group(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                               const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found) {
  const bool after = first < end; // the first line: then a line takes in those behind itself only
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += lanes) {
    const Fields others = load([&](std::size_t n) { return lines + k + n; });
    const unsigned inside = k + lanes > end ? (1u << (end - k)) - 1u : ~0u;
    const std::size_t stop = after && k + lanes - 1 < last ? k + lanes - 1 : last;
    for (std::size_t m = first; m < stop; ++m) {
      unsigned bits = near(lines[m], others, frame, span) & inside;
      if (after && m >= k)
        bits &= ~0u << (m + 1 - k);
      for (; bits; bits &= bits - 1)
        found[count++] = {static_cast<std::uint32_t>(m),
                          static_cast<std::uint32_t>(k + static_cast<unsigned>(__builtin_ctz(bits)))};
    }
  }
  return count;
}

} // namespace

extern const LineSweeps sweeps;
const LineSweeps sweeps = {sweep, sweep_group};

} // namespace keeler::KEELER_KERNEL_SPACE
