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

// The part of the text that ends with the last whole row of a step up to last_step.
std::string_view rows_up_to(const std::filesystem::path& file, std::string_view text, std::size_t header,
                            std::int64_t last_step) {
  std::size_t kept = header;
  for (std::size_t begin = header, end; (end = text.find('\n', begin)) != std::string_view::npos; begin = end + 1) {
    if (step_of(file, text.substr(begin, end - begin)) > last_step)
      break;
    kept = end + 1;
  }
  return text.substr(0, kept);
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

Series::Series(const std::filesystem::path& file, std::size_t columns)
    : file_(file, O_WRONLY | O_APPEND), columns_(columns) {}

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
  const std::string_view kept = rows_up_to(file, text, header.size(), last_step);
  if (kept.size() != text.size())
    write_text(file, kept);
  return {file, columns.size()};
}

void Series::append(std::int64_t step, std::span<const double> values) {
  assert(values.size() == columns_);
  const std::string row = fmt::format("{},{}\n", step, fmt::join(values, ","));
  file_.append_whole(std::as_bytes(std::span(row)));
}

void Series::sync() {
  file_.sync();
}

} // namespace keeler
