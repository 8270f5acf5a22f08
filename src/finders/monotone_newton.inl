// Source of the search; see monotone_newton.hpp. The including file sets KEELER_KERNEL_SPACE and defines Reals and
// Masks of `lanes` lanes (a double and a bool, or vectors), `PairElements load(pairs)`, `square_root`, `any(mask)`,
// `none()` and `lane(values, k)`. Everything here has internal linkage except `kernel`.
//
// Only + − * / and square roots, in this order: the same bits on every instruction set. A comparison with NaN proves
// nothing, so such pairs stay undecided.

namespace keeler::finders::KEELER_KERNEL_SPACE {
namespace {

constexpr double ulp = 2.220446049250313e-16;
constexpr double up = 1.0 + 1e-9; // for the roundings of bounds
constexpr int max_passes = 4;

inline Reals all(double value) {
  return Reals{} + value;
}
inline Reals larger(Reals a, Reals b) {
  return a > b ? a : b;
}
inline Reals smaller(Reals a, Reals b) {
  return a < b ? a : b;
}
inline Reals magnitude(Reals a) {
  return a < 0.0 ? -a : a;
}

// Taylor series of sin x and 1 − cos x: number of terms after the first of the sine, and in all of the cosine.
template<int SineTerms, int CosineTerms> struct Series {
  static void evaluate(Reals x, Reals& sine, Reals& one_minus_cosine) {
    constexpr double odd[] = {-1.0 / 6,        1.0 / 120,          -1.0 / 5040,           1.0 / 362880,
                              -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
    constexpr double even[] = {1.0 / 2,       -1.0 / 24,        1.0 / 720,           -1.0 / 40320,
                               1.0 / 3628800, -1.0 / 479001600, 1.0 / 87178291200.0, -1.0 / 20922789888000.0};
    const Reals q = x * x;
    Reals s = all(odd[SineTerms - 1]), c = all(even[CosineTerms - 1]);
    for (int k = SineTerms - 2; k >= 0; --k)
      s = odd[k] + q * s;
    for (int k = CosineTerms - 2; k >= 0; --k)
      c = even[k] + q * c;
    sine = x + x * q * s;
    one_minus_cosine = q * c;
  }
};

// Relative position, velocity and acceleration at a time, f = |d|² − R² and its derivatives.
struct Moment {
  Reals dx, dy, dz, vx, vy, vz, ax, ay, az;
  Reals distance2, gap, slope;

  Reals half_curvature() const { return vx * vx + vy * vy + vz * vz + (dx * ax + dy * ay + dz * az); } // f″/2
  Reals third(const MonotoneStep& step) const {                                                        // f‴
    const Reals jx = vx * -(step.kappa * step.kappa), jy = ax * -2.0, jz = vz * -(step.nu * step.nu);
    return 6.0 * (vx * ax + vy * ay + vz * az) + 2.0 * (dx * jx + dy * jy + dz * jz);
  }
};

template<class Terms> inline Moment at(const PairElements& p, const MonotoneStep& step, Reals time) {
  Reals sine, versine;
  Terms::evaluate(step.kappa * time, sine, versine);
  const Reals ec = p.e_cos - (p.e_cos * versine + p.e_sin * sine);
  const Reals es = p.e_sin - (p.e_sin * versine - p.e_cos * sine);
  if (step.nu != step.kappa)
    Terms::evaluate(step.nu * time, sine, versine);
  const Reals is = p.i_sin - (p.i_sin * versine - p.i_cos * sine);
  const Reals ic = p.i_cos - (p.i_cos * versine + p.i_sin * sine);
  const Reals drift = step.shear * p.guiding_x;
  Moment m;
  m.dx = p.guiding_x - ec, m.dy = p.guiding_y - drift * time + step.two_over_kappa * es, m.dz = is;
  m.vx = step.kappa * es, m.vy = 2.0 * ec - drift, m.vz = step.nu * ic;
  m.ax = (step.kappa * step.kappa) * ec, m.ay = (-2.0 * step.kappa) * es, m.az = -(step.nu * step.nu) * is;
  m.distance2 = m.dx * m.dx + m.dy * m.dy + m.dz * m.dz;
  m.gap = m.distance2 - p.radius_sum * p.radius_sum;
  m.slope = 2.0 * (m.dx * m.vx + m.dy * m.vy + m.dz * m.vz);
  return m;
}

// Bounds from the start of the search to its horizon.
struct Bounds {
  Reals span;
  Reals contact;         // gap_error at contact: a smaller |f| is contact
  Reals gap, slope;      // errors of f and f′ as evaluated
  Reals min_curvature;   // lower bound on f″
  Reals third;           // bound on |f‴|
  Reals curvature_error; // error of f″ as evaluated
  Reals rise;            // bound on the decrease of f′ per time, backwards
};

inline Bounds bounds(const PairElements& p, const MonotoneStep& step, const Moment& first, Reals curvature, Reals third,
                     Reals horizon) {
  const double k2 = step.kappa * step.kappa, n2 = step.nu * step.nu;
  const double fastest = step.kappa > step.nu ? step.kappa : step.nu;
  const Reals e2 = p.e_cos * p.e_cos + p.e_sin * p.e_sin, i2 = p.i_sin * p.i_sin + p.i_cos * p.i_cos;
  const Reals acceleration = up * square_root((4.0 * k2) * e2 + (n2 * n2) * i2);
  const Reals scale = square_root(larger(larger(p.guiding_x * p.guiding_x, p.guiding_y * p.guiding_y),
                                         larger((step.two_over_kappa * step.two_over_kappa) * e2, i2)));
  const Reals speed_scale = (step.shear + step.kappa + step.nu) * scale; // bound on |v| at all times
  Bounds b;
  b.span = up * (horizon - p.start);
  const Reals speed = up * square_root(first.vx * first.vx + first.vy * first.vy + first.vz * first.vz) +
                      1e-14 * speed_scale + acceleration * b.span;
  const Reals distance = up * square_root(first.distance2) + 1e-14 * scale + speed * b.span;
  const Reals radius_sum2 = p.radius_sum * p.radius_sum;
  b.contact = (4.0 * ulp) * (2.0 * radius_sum2 + 4.0 * p.radius_sum * scale);
  b.gap = (8.0 * ulp) * (distance * distance + radius_sum2 + 4.0 * distance * scale);
  b.slope = (32.0 * ulp) * (speed * (distance + scale) + distance * speed_scale);
  b.curvature_error = 4e-12 * (speed * speed_scale + (distance + scale) * acceleration);
  const Reals fourth =
      (2.0 * up) * acceleration * (4.0 * fastest * speed + 3.0 * acceleration + (fastest * fastest) * distance);
  b.third = magnitude(third) + fourth * b.span + fastest * b.curvature_error;
  b.min_curvature = curvature + smaller(third, Reals{}) * b.span - 0.5 * fourth * (b.span * b.span) - b.curvature_error;
  b.rise = up * larger(-b.min_curvature, Reals{});
  return b;
}

// True if f′ > 0 on the whole span.
inline Masks recedes(const Moment& first, const Bounds& b) {
  return first.slope - b.slope - b.rise * b.span > 0.0;
}

// True if the parabola below f has no root: its minimum is in the span, or at an end.
inline Masks stays_apart(const Moment& first, const Bounds& b) {
  const Reals m = b.min_curvature, above = first.gap - b.gap, steepest = magnitude(first.slope) + b.slope;
  const Reals low_slope = first.slope - b.slope;
  const Reals last = above + (low_slope + 0.5 * m * b.span) * b.span;
  const Masks nowhere_zero = steepest * steepest * up < 2.0 * m * above;
  const Masks minimum_at_ends = (m <= 0.0) | (low_slope + m * b.span <= 0.0);
  const Masks ends_apart = (above > 0.0) & (last > 1e-12 * (steepest + magnitude(m) * b.span) * b.span);
  return ((m > 0.0) & nowhere_zero) | (minimum_at_ends & ends_apart);
}

// Returns the time from the start to the first root of a parabola with the initial acceleration, corrected for the
// change of the acceleration. NaN if there is none.
inline Reals first_guess(const Moment& first, Reals half_curvature, Reals third) {
  const Reals square = first.slope * first.slope - 4.0 * half_curvature * first.gap;
  const Reals root = square_root(larger(square, Reals{}));
  const Reals after = 2.0 * first.gap / (root - first.slope);
  return after * (1.0 + third * (after * after) / (6.0 * root));
}

// Returns the horizon, slightly beyond the guess if that is in the span: bounds over shorter spans are tighter.
inline Reals horizon_of(const PairElements& p, const MonotoneStep& step, Reals guess) {
  const Reals beyond = p.start + 1.25 * guess, end = all(step.end);
  return ((guess > 0.0) & (beyond < end)) ? beyond : end;
}

struct Verdicts {
  Masks open;
  Reals exit = {}, time = {};

  void settle(Masks decided, MonotoneExit as) {
    exit = (open & decided) ? all(static_cast<double>(as)) : exit;
    open = open & !decided;
  }
};

template<class Terms>
inline void find_with(const PairElements& p, const MonotoneStep& step, Verdicts& verdicts, Reals& evaluations) {
  const Moment first = at<Terms>(p, step, p.start);
  const Reals half_curvature = first.half_curvature(), third = first.third(step);
  const Reals guess = first_guess(first, half_curvature, third), horizon = horizon_of(p, step, guess);
  const Bounds b = bounds(p, step, first, 2.0 * half_curvature, third, horizon);
  const Masks to_the_end = horizon == step.end;
  verdicts.open =
      (first.gap - first.gap == 0.0) & (first.slope - first.slope == 0.0) & (b.span > 0.0) & (p.start >= step.begin);
  evaluations = all(1.0);
  verdicts.time = p.start;
  const Masks closes = first.slope + b.slope < 0.0;
  verdicts.settle((first.gap <= 0.5 * b.contact) & closes, MonotoneExit::overlapping);
  verdicts.settle(to_the_end & recedes(first, b), MonotoneExit::receding);
  const Masks apart = to_the_end & stays_apart(first, b);
  verdicts.settle(apart & (first.slope >= 0.0), MonotoneExit::receding);
  verdicts.settle(apart, MonotoneExit::missed);
  verdicts.open = verdicts.open & (first.gap > 1.5 * b.contact) & closes; // within rounding of either: undecided
  if (!any(verdicts.open))
    return;

  const Reals target = 0.5 * b.contact;
  Reals t = p.start + guess;
  for (int pass = 0; pass < max_passes; ++pass) {
    verdicts.open = verdicts.open & (t > p.start);
    if (!any(verdicts.open))
      return;
    t = smaller(t, horizon);
    evaluations = evaluations + (verdicts.open ? all(1.0) : Reals{});
    const Moment now = at<Terms>(p, step, t);
    const Masks falls = now.slope + b.slope + b.rise * (t - p.start) < 0.0;
    verdicts.open = verdicts.open & falls;
    verdicts.settle((t == step.end) & (now.gap > b.gap), MonotoneExit::missed);

    // the root, by tangent and curvature; the distance of f from its target there, and its slope there
    const Reals above = now.gap - target, inverse = 1.0 / now.slope, k = now.half_curvature();
    const Reals tangent = above * inverse;
    const Reals next = t - (tangent + k * (tangent * tangent) * inverse);
    const Reals step_on = next - t, distance = magnitude(step_on), square = step_on * step_on;
    const Reals off = magnitude(above + step_on * (now.slope + k * step_on)) +
                      square * (b.third * distance * (1.0 / 6.0) + b.curvature_error);
    const Reals slope = now.slope + 2.0 * k * step_on + square * (0.5 * b.third) + b.curvature_error * distance;
    const Masks falls_until_next = slope + b.slope + b.rise * (next - p.start) < 0.0;
    const Masks found = (off <= 0.25 * b.contact) & falls_until_next & (next > p.start) & (next < horizon);
    verdicts.time = (verdicts.open & found) ? next : verdicts.time;
    verdicts.settle(found, MonotoneExit::hit);
    t = next;
  }
}

inline void find(const MonotonePair* pairs, const MonotoneStep& step, MonotoneAnswer* answers) {
  const PairElements p = load(pairs);
  Verdicts verdicts;
  Reals evaluations;
  if (step.largest_angle <= 0.01)
    find_with<Series<3, 3>>(p, step, verdicts, evaluations);
  else if (step.largest_angle <= 0.1)
    find_with<Series<4, 5>>(p, step, verdicts, evaluations);
  else
    find_with<Series<7, 8>>(p, step, verdicts, evaluations);
  for (std::size_t k = 0; k < lanes; ++k)
    answers[k] = {lane(verdicts.time, k), static_cast<MonotoneExit>(static_cast<std::int32_t>(lane(verdicts.exit, k))),
                  static_cast<std::int32_t>(lane(evaluations, k))};
}

} // namespace

extern const MonotoneNewton kernel;
const MonotoneNewton kernel = {lanes, find};

} // namespace keeler::finders::KEELER_KERNEL_SPACE
