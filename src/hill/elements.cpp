#include <keeler/hill/elements.hpp>

#include <cassert>

namespace keeler::hill {
namespace {

// Taylor series, truncated where terms are below half an ulp for |a| <= pi/4 (long) and |a| <= 0.01 (short). The choice
// depends only on the angle, so equal angles give equal bits.
struct SineCosine {
  double sine, cosine;
};

SineCosine short_series(double a) {
  const double q = a * a;
  return {a + a * q * (-1.0 / 6 + q * (1.0 / 120 - q * (1.0 / 5040))),
          1.0 + q * (-0.5 + q * (1.0 / 24 - q * (1.0 / 720)))};
}

SineCosine long_series(double a) {
  const double q = a * a;
  const double s =
      -1.0 / 6 +
      q * (1.0 / 120 +
           q * (-1.0 / 5040 +
                q * (1.0 / 362880 + q * (-1.0 / 39916800 + q * (1.0 / 6227020800.0 - q * (1.0 / 1307674368000.0))))));
  const double c =
      -0.5 + q * (1.0 / 24 + q * (-1.0 / 720 +
                                  q * (1.0 / 40320 + q * (-1.0 / 3628800 + q * (1.0 / 479001600.0 +
                                                                                q * (-1.0 / 87178291200.0 +
                                                                                     q * (1.0 / 20922789888000.0)))))));
  return {a + a * q * s, 1.0 + q * c};
}

// Computes sine and 1 − cosine in extended precision (Taylor series of a halved angle, then doublings).
struct ExtendedSineCosine {
  long double sine, one_minus_cosine;
};

ExtendedSineCosine extended_sine_cosine(double angle) {
  int halvings = 0;
  long double a = angle;
  for (; std::fabs(a) > 0.5L; ++halvings)
    a *= 0.5L;
  long double s = a, u = 0.0L, odd = a, even = -1.0L; // u = 1 − cos a
  for (int k = 1; k <= 12; ++k) {
    even *= -a * a / static_cast<long double>((2 * k - 1) * (2 * k));
    u += even;
    odd *= -a * a / static_cast<long double>((2 * k) * (2 * k + 1));
    s += odd;
  }
  for (; halvings > 0; --halvings) {
    const long double doubled = 2.0L * s * (1.0L - u);
    u = 2.0L * s * s;
    s = doubled;
  }
  return {s, u};
}

} // namespace

void sine_cosine(double angle, double& sine, double& cosine) {
  const double magnitude = std::fabs(angle);
  SineCosine r;
  if (magnitude <= 0.01) {
    r = short_series(angle);
  } else if (magnitude <= 0.785398163397448) {
    r = long_series(angle);
  } else { // pi/2 in three parts of 33 bits (Cody and Waite 1980)
    const double turns = std::nearbyint(angle * 0.63661977236758134308);
    const double a = ((angle - turns * 1.57079632673412561417e+00) - turns * 6.07710050630396597660e-11) -
                     turns * 2.02226624879595063154e-21;
    r = long_series(a);
    switch (static_cast<long long>(turns) & 3) {
    case 1:
      r = {r.cosine, -r.sine};
      break;
    case 2:
      r = {-r.sine, -r.cosine};
      break;
    case 3:
      r = {-r.cosine, r.sine};
      break;
    default:
      break;
    }
  }
  sine = r.sine;
  cosine = r.cosine;
}

Rotation::Rotation(const Frequencies& frequencies, double time_after) : after(time_after) {
  assert(frequencies.kappa > 0.0 && frequencies.nu > 0.0);
  sine_cosine(frequencies.kappa * after, sin_e, cos_e);
  if (frequencies.nu == frequencies.kappa) {
    sin_i = sin_e;
    cos_i = cos_e;
  } else {
    sine_cosine(frequencies.nu * after, sin_i, cos_i);
  }
}

Elements elements_from(const State& state, const Frequencies& f, const Rotation& r) {
  assert(f.kappa > 0.0 && f.nu > 0.0);
  const double a = 2.0 / (f.kappa * f.kappa);
  const double x = state.position.x();
  const double guiding_x = a * (state.velocity.y() + 2.0 * x);
  const double ec = guiding_x - x;
  const double es = state.velocity.x() / f.kappa;
  const double is = state.position.z();
  const double ic = state.velocity.z() / f.nu;
  Elements el;
  el.guiding_x = guiding_x;
  el.guiding_y = state.position.y() - a * state.velocity.x() + f.shear() * guiding_x * r.after;
  el.e_cos = ec * r.cos_e + es * r.sin_e;
  el.e_sin = es * r.cos_e - ec * r.sin_e;
  el.i_sin = is * r.cos_i - ic * r.sin_i;
  el.i_cos = ic * r.cos_i + is * r.sin_i;
  return el;
}

FixedRotation::FixedRotation(double angle) {
  assert(std::isfinite(angle));
  const ExtendedSineCosine exact = extended_sine_cosine(angle);
  sine = static_cast<double>(exact.sine);
  sine_low = static_cast<double>(exact.sine - sine);
  one_minus_cosine = static_cast<double>(exact.one_minus_cosine);
}

Rebase::Rebase(const Frequencies& f, double interval)
    : shift_(f.shear() * interval), e_(f.kappa * interval), i_(f.nu * interval) {}

} // namespace keeler::hill
