// Time series as CSV: one header line, then one row a sample, with the step first. A row is in the file when append()
// returns, and is there whole or not at all. A file that somebody removes or replaces meanwhile is written anew with
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

namespace keeler {

/// A series as it was read: a list of values for each column.
struct SeriesTable {
  std::vector<std::string> names; ///< "step" first
  std::vector<std::vector<double>> columns;

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// Null when there is no such column.
  const std::vector<double>* find(const std::string& name) const;
  /// Throws UsageError when there is no such column.
  const std::vector<double>& of(const std::string& name) const;
};

/// An incomplete last row is left out: the run may be writing it. Throws IoError when the file cannot be read or holds
/// something else.
SeriesTable read_series(const std::filesystem::path& file);

/// Returns the names in the first line but "step"; none where the file is missing or begins otherwise.
std::vector<std::string> series_names(const std::filesystem::path& file);

/// Steps without a row.
struct SeriesGap {
  std::int64_t from = 0, to = 0;
};

class Series {
public:
  /// Begins a file anew; the first column, "step", is added to those named. Throws IoError.
  static Series begin(const std::filesystem::path& file, const std::vector<std::string>& columns);

  /// Continues a file after a restart at `last_step`: rows of later steps, which the run will make again, and an
  /// incomplete last row are cut off first. A missing file is begun anew. `every`: there was a row in each step that is
  /// a multiple of it; gaps() tells what is missing. Throws IoError, also when the columns differ or a row is damaged.
  static Series resume(const std::filesystem::path& file, const std::vector<std::string>& columns,
                       std::int64_t last_step, std::optional<std::int64_t> every = {});

  /// Adds a row of one number a column, written so that reading gives the same bits. Throws IoError, and then the file
  /// ends with the row before; also when the rows before it are no more in the file.
  void append(std::int64_t step, std::span<const double> values);

  /// Forces the rows to disk. Do so before a checkpoint, so that the series reaches at least as far.
  void sync();

  /// What resume() did not find up to its last step. Nothing where it does not know how often there was a row.
  const std::vector<SeriesGap>& gaps() const { return gaps_; }

  /// Whether the file had to be written anew since this was asked last.
  bool take_restored() { return std::exchange(restored_, false); }

private:
  Series(const std::filesystem::path& file, std::size_t columns, std::string_view rows);

  void require_rows();

  std::filesystem::path path_;
  Descriptor file_;
  std::size_t columns_; // without the step
  std::size_t size_;    // of the file, as the last row left it
  bool restored_ = false;
  std::vector<SeriesGap> gaps_;
};

} // namespace keeler
