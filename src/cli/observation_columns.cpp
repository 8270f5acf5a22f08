#include "observation_columns.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/columns.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace keeler::cli {

ObservationColumns::ObservationColumns(const std::string& file) : file_(file) {
  files::Columns table = files::parse_columns(files::read_text(file), file);
  names_ = std::move(table.names);
  values_ = std::move(table.values);
  lines_ = std::move(table.lines);
  header_line_ = table.header_line;
  if (lines_.empty())
    throw UsageError(fmt::format("'{}' has no row; give at least one observation", file));
}

const std::vector<double>* ObservationColumns::optional(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? nullptr : &values_[static_cast<std::size_t>(found - names_.begin())];
}

const std::vector<double>& ObservationColumns::required(const std::string& name) const {
  const std::vector<double>* const values = optional(name);
  if (!values)
    fail_in_header(fmt::format("there is no column '{}'; name the columns in the line above the numbers", name));
  return *values;
}

bool ObservationColumns::first_of_two(const std::string& first, const std::string& second) const {
  const bool has_first = optional(first), has_second = optional(second);
  if (!has_first && !has_second)
    fail_in_header(
        fmt::format("there is no column '{}' or '{}'; name the columns in the line above the numbers", first, second));
  if (has_first && has_second)
    fail_in_header(fmt::format("of the columns '{}' and '{}' each determines the other; leave one", first, second));
  return has_first;
}

std::vector<double> ObservationColumns::azimuths() const {
  const bool named_so = first_of_two("azimuth", "longitude");
  std::vector<double> degrees = required(named_so ? "azimuth" : "longitude");
  for (std::size_t row = 0; row < degrees.size(); ++row) {
    if (!(std::fabs(degrees[row]) <= 720.0))
      fail(row, fmt::format("{:g} is not an azimuth in degrees; correct it", degrees[row]));
    if (!named_so)
      degrees[row] = -degrees[row];
  }
  return degrees;
}

void ObservationColumns::fail(std::size_t row, const std::string& what) const {
  assert(row < lines_.size());
  throw UsageError(fmt::format("{}:{}: {}", file_, lines_[row], what));
}

void ObservationColumns::fail_in_header(const std::string& what) const {
  throw UsageError(fmt::format("{}:{}: {}", file_, header_line_, what));
}

} // namespace keeler::cli
