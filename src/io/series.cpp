#include <keeler/io/series.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

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

} // namespace

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
