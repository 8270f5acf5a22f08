#include "observed_stars.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/columns.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::cli {

ObservedStars read_observed_stars(const std::string& file) {
  const files::Columns table = files::parse_columns(files::read_text(file), file);
  const auto column = [&](const char* name) -> const std::vector<double>* {
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    return found == table.names.end() ? nullptr : &table.values[static_cast<std::size_t>(found - table.names.begin())];
  };
  const auto one_of_two = [&](const char* first, const char* second) {
    if (!column(first) && !column(second))
      throw UsageError(
          fmt::format("{}:{}: there is no column '{}' or '{}'; name the columns in the line above the numbers", file,
                      table.header_line, first, second));
  };
  one_of_two("elevation", "elevation");
  one_of_two("azimuth", "longitude");
  one_of_two("transmission", "normal_optical_depth");
  constexpr double degree = pi / 180.0;
  ObservedStars observed;
  const std::vector<double>* const errors = column("error");
  observed.has_errors = errors != nullptr;
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    const auto fail = [&](const std::string& what) {
      throw UsageError(fmt::format("{}:{}: {}; correct it", file, table.lines[row], what));
    };
    light::StarTransmission one;
    const double elevation = (*column("elevation"))[row];
    if (!(elevation >= lowest_star && elevation <= 90.0))
      fail(fmt::format("the elevation {:g} is not from {:g} to 90 degrees", elevation, lowest_star));
    const double azimuth = column("azimuth") ? (*column("azimuth"))[row] : -(*column("longitude"))[row];
    if (!(std::fabs(azimuth) <= 720.0))
      fail(fmt::format("{:g} is not an azimuth in degrees", azimuth));
    one.star = {elevation * degree, azimuth * degree};
    one.transmission = column("transmission")
                           ? (*column("transmission"))[row]
                           : std::exp(-(*column("normal_optical_depth"))[row] / std::sin(one.star.elevation));
    if (!(one.transmission >= 0.0 && one.transmission <= 1.0))
      fail(fmt::format("the transmission {:g} is not from 0 to 1", one.transmission));
    one.error = errors ? (*errors)[row] : 0.01;
    if (!(one.error > 0.0 && std::isfinite(one.error)))
      fail(fmt::format("the error {:g} is not above 0", one.error));
    observed.transmissions.push_back(one);
  }
  if (observed.transmissions.empty())
    throw UsageError(fmt::format("'{}' has no row; give at least one occultation", file));
  return observed;
}

} // namespace keeler::cli
