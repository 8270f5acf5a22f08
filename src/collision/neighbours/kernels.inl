// The kernels of kernels.hpp for one instruction set. The including file sets KEELER_KERNEL_SPACE and defines
//   Floats, Integers, Unsigned    vectors of `lanes` lanes of 32 bits
//   Fields load(line_at)          the lines at line_at(0), line_at(1) …, one vector per field
//   unsigned nonzero(Integers)    one bit per lane
//   Doubles, Longs                vectors of `halves` lanes of 64 bits
//   Singles, Words                vectors of `halves` lanes of 32 bits
//   unsigned nonzero(Longs)       one bit per lane
//   void load_bodies(const double* rows, Doubles fields[8])    loads `halves` rows of eight
//   HalfFields load_half(const Line*)                          loads `halves` consecutive lines, one vector per field
//   void store_lines(Line*, Words x, Words y, Singles z, u, v, w, size, Words tag)
// Only plain arrays and these vectors: no inline function of another file may be compiled here, since the linker could
// use it on all processors. Everything here has internal linkage except `table`.

namespace keeler::collision::KEELER_KERNEL_SPACE {
namespace {

inline Floats floats(const Integers& values) {
  return __builtin_convertvector(values, Floats);
}

// Returns the difference modulo 2³², by unsigned integers, for which C++ defines it.
inline Integers minus(const Integers& a, const Integers& b) {
  return (Integers)((Unsigned)a - (Unsigned)b);
}

// Returns one bit per lane: set if its two lines may touch.
inline unsigned may_touch(const Fields& line, const Fields& other, const LineFrame& frame, const LineSpan& span) {
  const Integers offset = Integers{} + frame.offset_y;
  const Integers across = minus(other.x, line.x);
  // the image one box inward is ahead by the offset, the one outward behind; the difference overflows if it is nearer
  const Integers outward = ~(across >> 31);
  const Integers wrapped = ((other.x ^ line.x) & (other.x ^ across)) >> 31;
  const Integers behind = minus(outward, offset ^ outward) & wrapped;
  const Floats dx = frame.metres_x * floats(across);
  const Floats dy = frame.metres_y * floats(minus(minus(other.y, line.y), behind));
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

inline Fields all_lanes(const Line& line) {
  return {Integers{} + line.x, Integers{} + line.y, Floats{} + line.z,   Floats{} + line.u,
          Floats{} + line.v,   Floats{} + line.w,   Floats{} + line.size};
}

inline unsigned first_lanes(std::size_t count) {
  return count >= lanes ? ~0u : (1u << count) - 1u;
}

std::size_t sweep(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                  const std::uint32_t* indices, std::size_t count, std::uint32_t* kept) {
  const Fields one = all_lanes(line);
  std::size_t keeps = 0;
  for (std::size_t k = 0; k < count; k += lanes) {
    const Fields others = load([&](std::size_t n) { return lines + indices[k + n]; });
    for (unsigned bits = may_touch(one, others, frame, span) & first_lanes(count - k); bits; bits &= bits - 1)
      kept[keeps++] = indices[k + static_cast<unsigned>(__builtin_ctz(bits))];
  }
  return keeps;
}

std::size_t sweep_group(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                        const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found) {
  const bool after = first < end; // the range is behind the first line: each line is tested with the lines behind it
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += lanes) {
    const Fields others = load([&](std::size_t n) { return lines + k + n; });
    const unsigned inside = first_lanes(end - k);
    const std::size_t stop = after && k + lanes - 1 < last ? k + lanes - 1 : last;
    for (std::size_t m = first; m < stop; ++m) {
      unsigned bits = may_touch(all_lanes(lines[m]), others, frame, span) & inside;
      if (after && m >= k)
        bits &= ~0u << (m + 1 - k);
      for (; bits; bits &= bits - 1)
        found[count++] = {static_cast<std::uint32_t>(m),
                          static_cast<std::uint32_t>(k + static_cast<unsigned>(__builtin_ctz(bits)))};
    }
  }
  return count;
}

std::size_t filter(const Line* lines, const LineFrame& frame, const LineSpan& span, const LinePair* pairs,
                   std::size_t count, LinePair* kept) {
  std::size_t keeps = 0;
  for (std::size_t k = 0; k < count; k += lanes) {
    const Fields first = load([&](std::size_t n) { return lines + pairs[k + n].first; });
    const Fields second = load([&](std::size_t n) { return lines + pairs[k + n].second; });
    for (unsigned bits = may_touch(first, second, frame, span) & first_lanes(count - k); bits; bits &= bits - 1)
      kept[keeps++] = pairs[k + static_cast<unsigned>(__builtin_ctz(bits))];
  }
  return keeps;
}

constexpr double whole_numbers = 6755399441055744.0; // 1.5 · 2⁵²: doubles above it are integers
constexpr double single = 4e-6;                      // relative bound on the rounding of a line

inline Doubles rounded(const Doubles& value) {
  return (value + whole_numbers) - whole_numbers;
}

// Returns the lowest 32 bits of an integer.
inline Words words(const Doubles& whole) {
  return __builtin_convertvector((Longs)(whole + whole_numbers), Words);
}

inline Doubles magnitude(const Doubles& value) {
  return value < 0.0 ? -value : value;
}

inline Doubles doubles(const Words& values) {
  return __builtin_convertvector(values, Doubles);
}

inline Doubles doubles(const Singles& values) {
  return __builtin_convertvector(values, Doubles);
}

inline Singles singles(const Doubles& values) {
  return __builtin_convertvector(values, Singles);
}

// Makes the lines of one vector of particles. Returns a bit for each that may leave its reference path.
inline unsigned follow_some(const double* rows, const Line* references, const FollowFrame f, Line* lines) {
  Doubles b[8];
  load_bodies(rows, b);
  const Doubles &gx = b[0], &radius = b[6];
  const Doubles ec = b[2] * f.cos_e - b[3] * f.sin_e, es = b[3] * f.cos_e + b[2] * f.sin_e; // in the middle
  const Doubles is = b[4] * f.cos_i + b[5] * f.sin_i, ic = b[5] * f.cos_i - b[4] * f.sin_i;
  const Doubles gy = b[1] - (f.shear * f.after) * gx;
  const Doubles u = f.kappa * es, v = (2.0 - f.shear) * ec, w = f.nu * ic; // v: beyond the shear at x = X − e cos
  const Doubles curvature = (0.5 * f.half * f.half) * (2.0 * f.kappa * (magnitude(ec) + magnitude(es)) +
                                                       f.nu * f.nu * (magnitude(is) + magnitude(ic)));
  const Doubles size = radius + curvature;
  const Doubles path = f.half * (magnitude(u) + magnitude(v) + magnitude(w));
  const Doubles room = single * (size + path + magnitude(is)) + f.allowance;

  // in fractions of the box, in the cell
  const Doubles x = rounded((gx - ec) * f.per_metre_x);
  const Doubles boxes = rounded((x + 0.25) * (1.0 / full_turn));
  const Doubles y = rounded((gy + (2.0 / f.kappa) * es) * f.per_metre_y + boxes * f.offset);
  const Longs is_image = (Longs)(boxes != 0.0) | (Longs)(magnitude(y) >= 0.5 * full_turn);
  store_lines(lines, words(x), words(y), singles(is), singles(u), singles(v), singles(w), singles(size + room),
              __builtin_convertvector(is_image, Words));

  // offset from the nearest image of the reference path
  const HalfFields r = load_half(references);
  const Doubles rx = doubles(r.x), ru = doubles(r.u), rv = doubles(r.v), rw = doubles(r.w);
  const Doubles along = rv - rx * (f.shear * f.size_x / full_turn); // speed
  Doubles dx = x - (rx + ru * (f.since * f.per_metre_x));
  const Doubles outward = rounded(dx * (1.0 / full_turn));
  dx -= outward * full_turn;
  Doubles dy = y - (doubles(r.y) + along * (f.since * f.per_metre_y)) + (outward - boxes) * f.offset;
  dy -= full_turn * rounded(dy * (1.0 / full_turn));
  dx *= 1.0 / f.per_metre_x;
  dy *= 1.0 / f.per_metre_y;
  const Doubles dz = is - (doubles(r.z) + rw * f.since);
  const Doubles du = f.half * (u - ru), dv = f.half * (v - rv - f.shear * (dx + f.since * ru)), dw = f.half * (w - rw);
  const Doubles square = dx * dx + dy * dy + dz * dz + du * du + dv * dv + dw * dw;
  const Doubles product = magnitude(2.0 * (dx * du + dy * dv + dz * dw));
  const Doubles limit = doubles(r.size) - size - room;
  const Longs stays = (Longs)(square + product <= limit * limit) & (Longs)(limit >= 0.0); // at both ends, so in between
  return ~nonzero(stays);
}

std::size_t follow(const double* bodies, const Line* references, const FollowFrame& frame, std::size_t begin,
                   std::size_t end, Line* lines, std::uint32_t* escaped) {
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += halves) {
    const std::size_t here = end - k < halves ? end - k : halves;
    const double* rows = bodies + 8 * k;
    alignas(64) double last[8 * halves];
    if (here < halves) {
      for (std::size_t n = 0; n < 8 * halves; ++n)
        last[n] = rows[n < 8 * here ? n : n % 8];
      rows = last;
    }
    for (std::size_t n = 0; n < halves; ++n)
      __builtin_prefetch(rows + 8 * (16 + n));
    for (unsigned bits = follow_some(rows, references + k, frame, lines + k) & ((1u << here) - 1u); bits;
         bits &= bits - 1)
      escaped[count++] = static_cast<std::uint32_t>(k + static_cast<unsigned>(__builtin_ctz(bits)));
  }
  return count;
}

} // namespace

extern const Kernels table;
const Kernels table = {sweep, sweep_group, filter, follow};

} // namespace keeler::collision::KEELER_KERNEL_SPACE
