#include "text_files.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <string_view>

namespace keeler {
namespace {

std::string_view trimmed(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos)
    return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool separates(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';';
}

// The numbers of a line, one for each column of the key.
std::vector<double> parse_numbers(std::string_view line, const Key& key, const std::string& place) {
  const auto refuse = [&](const std::string& what) {
    throw UsageError(fmt::format("{}: {}, but a line must be {}{} ({}); correct this line", place, what,
                                 key.columns.size() == 1 ? "a number" : fmt::format("{} numbers", key.columns.size()),
                                 key.range.words().empty() ? "" : " " + key.range.words(),
                                 fmt::join(key.columns, ", ")));
  };
  std::vector<double> numbers;
  const char *at = line.data(), *const end = at + line.size();
  while (at != end) {
    double number = 0.0;
    const auto [after, fault] = std::from_chars(at, end, number);
    if (fault != std::errc{} || (after != end && !separates(*after)))
      refuse("not a number");
    if (!std::isfinite(number) || !key.range.contains(number))
      refuse(fmt::format("{:g}", number));
    numbers.push_back(number);
    for (at = after; at != end && separates(*at);)
      ++at;
  }
  if (numbers.size() != key.columns.size())
    refuse(fmt::format("{} number{}", numbers.size(), numbers.size() == 1 ? "" : "s"));
  return numbers;
}

} // namespace

std::string read_text_file(const std::string& path, const std::string& place) {
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  std::string text;
  char part[1 << 16];
  bool failed = !file;
  for (std::size_t got = 1; !failed && got > 0;) {
    got = std::fread(part, 1, sizeof part, file.get());
    text.append(part, got);
    failed = std::ferror(file.get()) != 0; // a directory opens and fails here
  }
  if (failed) {
    const std::string what = path == place ? "" : path + " ";
    throw UsageError(fmt::format("{}: {}cannot be read ({}); check the path and its permissions", place, what,
                                 std::strerror(errno)));
  }
  return text;
}

NumberRows read_rows(const std::string& path, const Key& key, const std::string& place) {
  std::istringstream lines(read_text_file(path, place));
  NumberRows rows;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (const std::string_view text = trimmed(line); !text.empty())
      rows.push_back(parse_numbers(text, key, fmt::format("{}:{}:1", path, number)));
  if (rows.empty())
    throw UsageError(fmt::format("{}: {} has no numbers in it (it is empty or all comments); write {} on each line",
                                 place, path, fmt::join(key.columns, " and ")));
  return rows;
}

} // namespace keeler
