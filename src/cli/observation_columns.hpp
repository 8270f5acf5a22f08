// The columns of a table of observations: each by its name, and the azimuths by either of their names.
#pragma once

#include <string>
#include <vector>

namespace keeler::cli {

/// A table of numbers in a file, with its columns by name.
class ObservationColumns {
public:
  /// Throws UsageError "FILE:LINE: …", IoError.
  explicit ObservationColumns(const std::string& file);

  std::size_t rows() const { return lines_.size(); }

  /// Returns nullptr if there is no such column.
  const std::vector<double>* optional(const std::string& name) const;

  /// Throws UsageError if there is no such column.
  const std::vector<double>& required(const std::string& name) const;

  /// Returns whether the table has the first of two columns and not the second. Throws UsageError if it has none of
  /// them, or both: each determines the other.
  bool first_of_two(const std::string& first, const std::string& second) const;

  /// Returns the azimuths of all rows in degrees, from the column azimuth or longitude. Throws UsageError.
  std::vector<double> azimuths() const;

  /// Throws UsageError with the file and the line of a row.
  [[noreturn]] void fail(std::size_t row, const std::string& what) const;

private:
  [[noreturn]] void fail_in_header(const std::string& what) const;

  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> values_;
  std::vector<std::size_t> lines_;
  std::size_t header_line_ = 0;
};

} // namespace keeler::cli
