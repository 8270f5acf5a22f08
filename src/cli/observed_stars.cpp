#include "observed_stars.hpp"

#include "observation_columns.hpp"

#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::cli {

ObservedStars read_observed_stars(const std::string& file) {
  constexpr double degree = pi / 180.0;
  const ObservationColumns table(file);
  const std::vector<double>& elevations = table.required("elevation");
  const std::vector<double> azimuths = table.azimuths();
  const bool transmitted = table.first_of_two("transmission", "normal_optical_depth");
  const std::vector<double>& seen = table.required(transmitted ? "transmission" : "normal_optical_depth");
  const std::vector<double>* const errors = table.optional("error");
  ObservedStars observed;
  observed.has_errors = errors != nullptr;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    light::StarTransmission one;
    if (!(elevations[row] >= lowest_star && elevations[row] <= 90.0))
      table.fail(row, fmt::format("the elevation {:g} is not from {:g} to 90 degrees; correct it", elevations[row],
                                  lowest_star));
    one.star = {elevations[row] * degree, azimuths[row] * degree};
    one.transmission = transmitted ? seen[row] : std::exp(-seen[row] / std::sin(one.star.elevation));
    if (!(one.transmission >= 0.0 && one.transmission <= 1.0))
      table.fail(row, fmt::format("the transmission {:g} is not from 0 to 1; correct it", one.transmission));
    one.error = errors ? (*errors)[row] : 0.01;
    if (!(one.error > 0.0 && std::isfinite(one.error)))
      table.fail(row, fmt::format("the error {:g} is not above 0; correct it", one.error));
    observed.transmissions.push_back(one);
  }
  return observed;
}

} // namespace keeler::cli
