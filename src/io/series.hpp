// Time series as CSV: one header line, then one row per sample, with the step first. When append() returns, the row is
// in the file; a row is written completely or not at all. A file that is removed or replaced meanwhile is restored with
// all its rows.
#pragma once

#include <keeler/files/descriptor.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace keeler::io {

/// A series that was read.
struct SeriesTable {
  std::vector<std::string> names;           ///< "step" first
  std::vector<std::vector<double>> columns; ///< values of each column, all of equal length

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// Returns a column, or null when there is no such column.
  const std::vector<double>* find(const std::string& name) const;
  /// Returns a column. Throws UsageError when there is no such column.
  const std::vector<double>& of(const std::string& name) const;
};

/// Reads a series without an incomplete last row, which the run may still be writing. Throws IoError when the file
/// cannot be read or is not a series.
SeriesTable read_series(const std::filesystem::path& file);

/// Returns the names in the first line except "step"; none when the file is missing or is not a series.
std::vector<std::string> series_names(const std::filesystem::path& file);

/// Steps without a row, `from` and `to` included.
struct SeriesGap {
  std::int64_t from = 0, to = 0;
};

class Series {
public:
  /// Creates or replaces a file; the first column, "step", is added to `columns`. Throws IoError.
  static Series begin(const std::filesystem::path& file, const std::vector<std::string>& columns);

  /// Continues a file after a restart at `last_step`: first removes rows of later steps, which the run will compute
  /// again, and an incomplete last row. A missing file is created. If `every` (> 0) is given, a row is expected at each
  /// multiple of it, and gaps() returns the missing ones. Throws IoError, also when the columns differ or a row is
  /// damaged.
  static Series resume(const std::filesystem::path& file, const std::vector<std::string>& columns,
                       std::int64_t last_step, std::optional<std::int64_t> every = {});

  /// Adds a row with one number per column, in digits that read back bit for bit. Throws IoError, also when earlier
  /// rows are no longer in the file; the file then ends with the row before.
  void append(std::int64_t step, std::span<const double> values);

  /// Forces the rows to disk. Call it before a checkpoint, so that the series reaches at least as far.
  void sync();

  /// Returns the rows that resume() missed up to its last step; empty when it was called without `every`.
  const std::vector<SeriesGap>& gaps() const { return gaps_; }

  /// True if the file had to be restored since the last call.
  bool take_restored() { return std::exchange(restored_, false); }

private:
  Series(const std::filesystem::path& file, std::size_t columns, std::string_view rows);

  void require_rows();

  std::filesystem::path path_;
  files::Descriptor file_;
  std::size_t columns_; // without the step
  std::size_t size_;    // of the file after the last row, bytes
  bool restored_ = false;
  std::vector<SeriesGap> gaps_;
};

} // namespace keeler::io
