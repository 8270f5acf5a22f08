#include <keeler/initial_conditions/streamlines.hpp>

#include <keeler/core/units.hpp>

#include <cassert>

namespace keeler::initial_conditions {

Streamlines Streamlines::bunched(int waves, double length, double q) {
  assert(waves != 0 && length > 0.0);
  const double wave_number = two_pi * waves / length;
  return {{{wave_number, q / std::fabs(wave_number), 0.0}}, 0.0};
}

// φ = κt − kX + π/2 − p: with x = X − e cos φ the density − ∂x/∂X + 1 is k e sin φ = q cos(kX + p) at time zero.
void Streamlines::add_outward(int n, double length, double q, double phase) {
  assert(n > 0 && length > 0.0);
  const double k = two_pi * n / length;
  waves.push_back({-k, q / k, 0.5 * pi - phase});
}

// φ = κt + kX + p − π/2: the density is − k e sin φ.
void Streamlines::add_inward(int n, double length, double q, double phase) {
  assert(n > 0 && length > 0.0);
  const double k = two_pi * n / length;
  waves.push_back({k, q / k, phase - 0.5 * pi});
}

void Streamlines::add_standing(int n, double length, double q, double phase) {
  add_outward(n, length, 0.5 * q, phase);
  add_inward(n, length, 0.5 * q, phase);
}

Elements Streamlines::elements(double guiding_x) const {
  Elements sum{guiding_x, 0.0, 0.0, 0.0, 0.0, inclination};
  for (const EccentricityWave& wave : waves) {
    double sine, cosine;
    hill::sine_cosine(wave.wave_number * guiding_x + wave.phase, sine, cosine);
    sum.e_cos += wave.eccentricity * cosine;
    sum.e_sin += wave.eccentricity * sine;
  }
  return sum;
}

double Streamlines::spacing(double guiding_x) const {
  double slope = 1.0;
  for (const EccentricityWave& wave : waves) {
    double sine, cosine;
    hill::sine_cosine(wave.wave_number * guiding_x + wave.phase, sine, cosine);
    slope += wave.wave_number * (wave.eccentricity * sine);
  }
  return slope;
}

double Streamlines::guiding_x(double x) const {
  double farthest = 0.0;
  for (const EccentricityWave& wave : waves)
    farthest += wave.eccentricity;
  double low = x - farthest, high = x + farthest; // x(X) increases, with |x − X| <= Σ e
  for (int halving = 0; halving < 60 && low < high; ++halving) {
    const double middle = 0.5 * (low + high);
    (middle - elements(middle).e_cos < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace keeler::initial_conditions
