// Text of the sweep; see line_sweep.hpp. The including file sets KEELER_KERNEL_SPACE and defines the vectors Floats and
// Integers of `lanes` lanes and `unsigned nonzero(Integers)`, a bit a lane. Everything here has internal linkage except
// `sweep`.

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

inline Floats load(const float* from) {
  Floats value;
  __builtin_memcpy(&value, from, sizeof value);
  return value;
}

inline Integers load(const std::int32_t* from) {
  Integers value;
  __builtin_memcpy(&value, from, sizeof value);
  return value;
}

inline Floats metres(const Integers& fraction) {
  return __builtin_convertvector(fraction, Floats);
}

// Differences wrap: those of unsigned integers, to be defined in C++.
inline Integers minus(const Integers& a, const Integers& b) {
  return (Integers)((Unsigned)a - (Unsigned)b);
}

} // namespace

extern const LineSweep sweep;
const LineSweep sweep = [](const Line& line, const LineArrays& lines, const LineFrame& frame, const LineSpan& span,
                           std::size_t begin, std::size_t end, std::uint32_t* found) -> std::size_t {
  const Integers x = Integers{} + line.x, y = Integers{} + line.y, offset = Integers{} + frame.offset_y;
  const Floats first = Floats{} + span.begin, last = Floats{} + span.end;
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += lanes) {
    const Integers other_x = load(lines.x + k);
    const Integers across = minus(other_x, x);
    // an image one box inward is ahead by the offset, one outward behind: seen by the overflow of the difference
    const Integers outward = ~(across >> 31);
    const Integers wrapped = ((other_x ^ x) & (other_x ^ across)) >> 31;
    const Integers shift = minus(offset ^ outward, outward) & wrapped;
    const Floats dx = frame.metres_x * metres(across);
    const Floats dy = frame.metres_y * metres(minus(minus(load(lines.y + k), y), minus(Integers{}, shift)));
    const Floats dz = load(lines.z + k) - line.z;
    const Floats du = load(lines.u + k) - line.u;
    const Floats dv = load(lines.v + k) - line.v - frame.shear * dx;
    const Floats dw = load(lines.w + k) - line.w;
    const Floats size = load(lines.size + k) + line.size;
    const Floats closing = -(dx * du + dy * dv + dz * dw);
    Floats time = closing / (du * du + dv * dv + dw * dw + 1e-30f);
    time = time > first ? time : first;
    time = time < last ? time : last;
    const Floats cx = dx + time * du, cy = dy + time * dv, cz = dz + time * dw;
    const Integers near = cx * cx + cy * cy + cz * cz <= size * size;
    unsigned bits = nonzero(near);
    if (k + lanes > end)
      bits &= (1u << (end - k)) - 1u;
    for (; bits; bits &= bits - 1)
      found[count++] = static_cast<std::uint32_t>(k + static_cast<unsigned>(__builtin_ctz(bits)));
  }
  return count;
};

} // namespace keeler::KEELER_KERNEL_SPACE
