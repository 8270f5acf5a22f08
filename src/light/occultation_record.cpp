#include "occultation_record.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::light {
namespace {

namespace unit = quantities::unit;
using quantities::Spread, quantities::Value, quantities::value_of;

constexpr double degrees_per_rad = 180.0 / pi;
constexpr char no_variance[] = "the variance is not above 0";

std::vector<quantities::QuantityRow<FootprintStatistics>> star_rows() {
  using Of = const FootprintStatistics&;
  return {
      {{"elevation", unit::degrees, "B", "elevation of the star above the ring plane"},
       [](Of s) -> Value { return std::round(s.star.elevation * degrees_per_rad * 1e10) / 1e10; }},
      {{"azimuth", unit::degrees, "phi", "azimuth of the star, from the radius outward to the orbital motion"},
       [](Of s) -> Value { return std::round(s.star.azimuth * degrees_per_rad * 1e10) / 1e10; }},
      {{"transmission", unit::none, "T", "mean fraction of the star's light that passes", Spread::error},
       [](Of s) -> Value { return value_of(std::optional(s.transmission)); }},
      {{"normal_optical_depth", unit::none, "tau", "-sin B ln T"},
       [](Of s) -> Value { return value_of(s.optical_depth, "no light passes"); }},
      {{"excess_variance", unit::none, "variance",
        "of T from sample to sample, without photon noise: in counts, times the square of the star's counts in a "
        "sample",
        Spread::error},
       [](Of s) -> Value { return value_of(std::optional(s.variance)); }},
      {{"skewness", unit::none, "skewness", "third central moment of T over variance^(3/2)", Spread::error},
       [](Of s) -> Value { return s.skewness ? value_of(s.skewness) : quantities::Unknown{no_variance}; }},
      {{"kurtosis", unit::none, "kurtosis", "fourth central moment of T over variance squared, less 3"},
       [](Of s) -> Value { return value_of(s.kurtosis, no_variance); }},
      {{"effective_radius", unit::metres, "radius",
        "of equal spheres at random with this T and variance (Showalter & Nicholson 1990; Colwell et al. 2018)"},
       [](Of s) -> Value { return value_of(s.effective_radius, no_variance); }},
  };
}

Value fitted(double value, double error) {
  return value_of(std::optional(Estimate{value, error}));
}

std::vector<quantities::QuantityRow<FittedWakes>> fit_rows() {
  using Of = const FittedWakes&;
  return {
      {{"height_to_width", unit::none, "H/W", "height of the bars over their width", Spread::error},
       [](Of f) -> Value { return fitted(f.model.height, f.errors.height); }},
      {{"gap_to_width", unit::none, "S/W", "width of the gaps over that of the bars", Spread::error},
       [](Of f) -> Value { return fitted(f.model.gap, f.errors.gap); }},
      {{"gap_optical_depth", unit::none, "gap tau", "normal optical depth of the gaps", Spread::error},
       [](Of f) -> Value { return fitted(f.model.gap_depth, f.errors.gap_depth); }},
      {{"bar_azimuth", unit::degrees, "azimuth",
        "of the bars, from the radius outward to the orbital motion; less 90 it is the pitch", Spread::error},
       [](Of f) -> Value { return fitted(f.model.azimuth * degrees_per_rad, f.errors.azimuth * degrees_per_rad); }},
      {{"chi_square", unit::none, "chi-square", "sum of (difference/error) squared"},
       [](Of f) -> Value { return f.chi_square; }},
      {{"degrees_of_freedom", unit::none, "degrees of freedom", "transmissions less 4"},
       [](Of f) -> Value { return std::uint64_t{f.freedom}; }},
  };
}

} // namespace

quantities::Record record_of(const FootprintStatistics& statistics) {
  return {entries_of(star_rows(), statistics)};
}

quantities::Record record_of(const FittedWakes& fit) {
  return {entries_of(fit_rows(), fit)};
}

std::optional<FittedWakes> fit_wakes(std::span<const FootprintStatistics> found, BarSection section) {
  constexpr double min_error = 1e-6; // of a transmission: tracks that agree leave none
  std::vector<StarTransmission> transmissions;
  for (const FootprintStatistics& one : found)
    transmissions.push_back({one.star, one.transmission.value, std::max(one.transmission.error, min_error)});
  return fit_wakes(transmissions, section);
}

std::vector<quantities::Quantity> occultation_quantities() {
  return quantities_of(star_rows());
}

std::vector<quantities::Quantity> wake_model_quantities() {
  return quantities_of(fit_rows());
}

} // namespace keeler::light
