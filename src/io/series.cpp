#include <keeler/io/series.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <fcntl.h>

namespace keeler::io {
namespace {

std::string header_line(const std::vector<std::string>& columns) {
  return fmt::format("step,{}\n", fmt::join(columns, ","));
}

// Checks the rows of a series that is to be continued.
class RowReader {
public:
  RowReader(const std::filesystem::path& file, std::string_view text, std::size_t columns,
            std::optional<std::int64_t> every)
      : file_(file), text_(text), columns_(columns), every_(every) {}

  /// Returns the text up to the last complete row of a step <= last_step. Precondition: it begins with a header line.
  std::string_view rows_up_to(std::int64_t last_step) {
    std::size_t kept = text_.find('\n') + 1;
    for (std::size_t begin = kept, end; (end = text_.find('\n', begin)) != text_.npos; begin = kept = end + 1) {
      ++line_;
      const std::int64_t step = step_of(text_.substr(begin, end - begin));
      if (step > last_step)
        break;
      take(step);
    }
    if (every_ && next_ <= last_step)
      gaps_.push_back({next_, last_step});
    return text_.substr(0, kept);
  }

  std::vector<SeriesGap> gaps() { return std::move(gaps_); }

private:
  std::int64_t step_of(std::string_view row) const {
    std::int64_t step = 0;
    const auto [end, error] = std::from_chars(row.data(), row.data() + row.size(), step);
    if (error != std::errc{} || end == row.data() + row.size() || *end != ',')
      fail(row, "has no step");
    if (static_cast<std::size_t>(std::count(row.begin(), row.end(), ',')) != columns_)
      fail(row, "has another number of values");
    if (step < last_ || (every_ && step % *every_ != 0))
      fail(row, "is out of order");
    return step;
  }

  void take(std::int64_t step) {
    last_ = step;
    if (!every_ || step == next_ - *every_) // the step of the row before: one row per moonlet
      return;
    if (step > next_)
      gaps_.push_back({next_, step - 1});
    next_ = step + *every_;
  }

  [[noreturn]] void fail(std::string_view row, const char* what) const {
    throw IoError(
        fmt::format("cannot continue '{}': line {} {} ({}); repair it, or remove the file to go on without its "
                    "rows",
                    file_.string(), line_, what, row.substr(0, 40)));
  }

  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t columns_, line_ = 1;
  std::optional<std::int64_t> every_;
  std::int64_t last_ = 0, next_ = 0;
  std::vector<SeriesGap> gaps_;
};

std::vector<std::string_view> fields_of(std::string_view row) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0, end; begin <= row.size(); begin = end + 1) {
    end = std::min(row.find(',', begin), row.size());
    fields.push_back(row.substr(begin, end - begin));
  }
  return fields;
}

// Opens a file with `rows` that was just written; writes them again if it was removed since.
files::Descriptor open_with(const std::filesystem::path& file, std::string_view rows) {
  files::Descriptor opened(file, O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW);
  if (opened.size() == 0)
    opened.append_whole(std::as_bytes(std::span(rows)));
  return opened;
}

} // namespace

const std::vector<double>* SeriesTable::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

const std::vector<double>& SeriesTable::of(const std::string& name) const {
  const std::vector<double>* const column = find(name);
  if (!column)
    throw UsageError(fmt::format("the series has no column '{}'; it was written by another version of Keeler", name));
  return *column;
}

namespace {

// Throws IoError unless time_orbits is finite and does not decrease: rates are computed between rows. Only
// impact_speeds.csv has no such column.
void require_rising_times(const SeriesTable& table, const std::filesystem::path& file) {
  const std::vector<double>* const times = table.find("time_orbits");
  double last = 0.0;
  for (std::size_t k = 0; times && k < times->size(); last = (*times)[k], ++k)
    if (!((*times)[k] >= last && std::isfinite((*times)[k])))
      throw IoError(fmt::format("line {} of '{}' has time_orbits {} after {}; the file is damaged", k + 2,
                                file.string(), (*times)[k], last));
}

} // namespace

SeriesTable read_series(const std::filesystem::path& file) {
  const std::string text = files::read_lines(file);
  SeriesTable table;
  std::size_t line = 0;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::vector<std::string_view> fields = fields_of(std::string_view(text).substr(begin, end - begin));
    if (++line == 1) {
      table.names.assign(fields.begin(), fields.end());
      table.columns.resize(fields.size());
      if (table.names.front() != "step")
        throw IoError(fmt::format("'{}' is not a series: its first column is not 'step'", file.string()));
      continue;
    }
    if (fields.size() != table.names.size())
      throw IoError(fmt::format("'{}', line {}: {} values in {} columns; the file is damaged", file.string(), line,
                                fields.size(), table.names.size()));
    for (std::size_t k = 0; k < fields.size(); ++k) {
      double value = 0.0;
      const auto [at, error] = std::from_chars(fields[k].data(), fields[k].data() + fields[k].size(), value);
      if (error != std::errc{} || at != fields[k].data() + fields[k].size())
        throw IoError(fmt::format("'{}', line {}: '{}' is no number; the file is damaged", file.string(), line,
                                  fields[k].substr(0, 40)));
      table.columns[k].push_back(value);
    }
  }
  if (line == 0)
    throw IoError(fmt::format("'{}' is empty; there is no series to measure", file.string()));
  require_rising_times(table, file);
  return table;
}

std::vector<std::string> series_names(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    return {};
  const std::string text = files::read_lines(file);
  const std::vector<std::string_view> fields = fields_of(std::string_view(text).substr(0, text.find('\n')));
  if (fields.front() != "step")
    return {};
  return {fields.begin() + 1, fields.end()};
}

Series::Series(const std::filesystem::path& file, std::size_t columns, std::string_view rows)
    : path_(file), file_(open_with(file, rows)), columns_(columns), size_(rows.size()) {}

Series Series::begin(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  const std::string header = header_line(columns);
  files::write_text(file, header);
  return {file, columns.size(), header};
}

Series Series::resume(const std::filesystem::path& file, const std::vector<std::string>& columns,
                      std::int64_t last_step, std::optional<std::int64_t> every) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    files::write_text(file, header_line(columns));
  const std::string text = files::read_lines(file), header = header_line(columns);
  if (!text.starts_with(header))
    throw IoError(
        fmt::format("cannot continue '{}': its first line is not the names of its columns ({}); repair it, or "
                    "remove the file to go on without its rows",
                    file.string(), header.substr(0, header.size() - 1)));
  RowReader rows(file, text, columns.size(), every);
  const std::string_view kept = rows.rows_up_to(last_step);
  if (std::filesystem::file_size(file, unknown) != kept.size())
    files::write_text(file, kept);
  Series series(file, columns.size(), kept);
  series.gaps_ = rows.gaps();
  return series;
}

void Series::append(std::int64_t step, std::span<const double> values) {
  assert(values.size() == columns_);
  assert(step >= 0);
  const std::string row = fmt::format("{},{}\n", step, fmt::join(values, ","));
  require_rows();
  file_.append_whole(std::as_bytes(std::span(row)));
  size_ += row.size();
}

void Series::sync() {
  require_rows();
  file_.sync();
}

// Restores a file that was removed or renamed: the open descriptor still has its rows.
void Series::require_rows() {
  std::error_code gone;
  if (std::filesystem::file_size(path_, gone) == size_ && !gone)
    return;
  if (const std::size_t size = file_.size(); size != size_)
    throw IoError(fmt::format("'{}' was changed by another program while the run wrote to it ({} bytes instead of {}), "
                              "so rows may be lost; restore the missing rows, then resume the run",
                              path_.string(), size, size_));
  const std::string rows = file_.read_all();
  files::write_text(path_, rows);
  file_ = open_with(path_, rows);
  restored_ = true;
}

} // namespace keeler::io
