#include <keeler/states/streamlines.hpp>

#include <keeler/core/units.hpp>

namespace keeler {

Streamlines Streamlines::bunched(int waves, double length, double q) {
  const double wave_number = two_pi * waves / length;
  return {wave_number, q / std::fabs(wave_number), 0.0};
}

Elements Streamlines::elements(double guiding_x) const {
  double sine, cosine;
  sine_cosine(wave_number * guiding_x, sine, cosine);
  return {guiding_x, 0.0, eccentricity * cosine, eccentricity * sine, 0.0, inclination};
}

double Streamlines::spacing(double guiding_x) const {
  return 1.0 + wave_number * elements(guiding_x).e_sin;
}

double Streamlines::guiding_x(double x) const {
  double low = x - eccentricity, high = x + eccentricity; // x(X) rises, and is nowhere farther from X than e
  for (int halving = 0; halving < 60 && low < high; ++halving) {
    const double middle = 0.5 * (low + high);
    (middle - elements(middle).e_cos < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace keeler
