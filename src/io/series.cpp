#include <keeler/io/series.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <fcntl.h>

namespace keeler {
namespace {

std::string header_line(const std::vector<std::string>& columns) {
  return fmt::format("step,{}\n", fmt::join(columns, ","));
}

// The step a row begins with; throws when it has none.
std::int64_t step_of(const std::filesystem::path& file, std::string_view row) {
  std::int64_t step = 0;
  const auto [end, error] = std::from_chars(row.data(), row.data() + row.size(), step);
  if (error != std::errc{} || end == row.data() + row.size() || *end != ',')
    throw IoError(fmt::format("cannot continue '{}': this row has no step: {}", file.string(), row));
  return step;
}

struct Rows {
  std::string_view text;            // with the header
  std::optional<std::int64_t> last; // step; none: no row
};

// The part of the text that ends with the last whole row of a step up to last_step.
Rows rows_up_to(const std::filesystem::path& file, std::string_view text, std::size_t header, std::int64_t last_step) {
  Rows rows{text.substr(0, header), {}};
  for (std::size_t begin = header, end; (end = text.find('\n', begin)) != std::string_view::npos; begin = end + 1) {
    const std::int64_t step = step_of(file, text.substr(begin, end - begin));
    if (step > last_step)
      break;
    rows = {text.substr(0, end + 1), step};
  }
  return rows;
}

std::vector<std::string_view> fields_of(std::string_view row) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0, end; begin <= row.size(); begin = end + 1) {
    end = std::min(row.find(',', begin), row.size());
    fields.push_back(row.substr(begin, end - begin));
  }
  return fields;
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

SeriesTable read_series(const std::filesystem::path& file) {
  const std::string text = read_text(file);
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
  return table;
}

Series::Series(const std::filesystem::path& file, std::size_t columns, std::optional<std::int64_t> last_found)
    : path_(file), file_(file, O_RDWR | O_APPEND), columns_(columns), size_(file_.size()), last_found_(last_found) {}

Series Series::begin(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  write_text(file, header_line(columns));
  return {file, columns.size()};
}

Series Series::resume(const std::filesystem::path& file, const std::vector<std::string>& columns,
                      std::int64_t last_step) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    return begin(file, columns);
  const std::string text = read_text(file), header = header_line(columns);
  if (!text.starts_with(header))
    throw IoError(fmt::format("cannot continue '{}': its first line is not: {}", file.string(),
                              header.substr(0, header.size() - 1)));
  const Rows kept = rows_up_to(file, text, header.size(), last_step);
  if (kept.text.size() != text.size())
    write_text(file, kept.text);
  return {file, columns.size(), kept.last};
}

void Series::append(std::int64_t step, std::span<const double> values) {
  assert(values.size() == columns_);
  const std::string row = fmt::format("{},{}\n", step, fmt::join(values, ","));
  require_rows();
  file_.append_whole(std::as_bytes(std::span(row)));
  size_ += row.size();
}

void Series::sync() {
  require_rows();
  file_.sync();
}

// What is open keeps its rows when its name is taken from it, but nobody would find them.
void Series::require_rows() {
  std::error_code gone;
  if (std::filesystem::file_size(path_, gone) == size_ && !gone)
    return;
  const std::string rows = file_.read_all();
  if (rows.size() != size_)
    throw IoError(fmt::format("'{}' was changed by another program while the run wrote to it ({} bytes instead of {}), "
                              "so rows may be lost; put the rows back that are missing, then resume the run",
                              path_.string(), rows.size(), size_));
  write_text(path_, rows);
  file_ = Descriptor(path_, O_RDWR | O_APPEND);
  restored_ = true;
}

} // namespace keeler
