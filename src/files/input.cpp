#include <keeler/files/input.hpp>

#include "content.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

namespace keeler::files {
namespace {

double number_of(const std::string& word) {
  double number = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = fault == std::errc{} && end == word.data() + word.size();
  return whole ? number : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

void refuse_utf16(std::string_view text, const std::string& what) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw UsageError(fmt::format("{}is a text in UTF-16 (its byte order mark says so); save it as UTF-8", what));
}

std::string read_input(const std::filesystem::path& file, const std::string& location) {
  constexpr std::size_t max_bytes = std::size_t{1} << 30;
  std::optional<std::string> text = content_of<std::string>(file, max_bytes);
  const std::string what = file == location ? "" : file.string() + " ";
  if (!text)
    throw UsageError(fmt::format("{}: {}cannot be read ({}); check the path and its permissions", location, what,
                                 std::strerror(errno)));
  refuse_utf16(*text, fmt::format("{}: {}", location, what));
  text->erase(0, text->size() - without_byte_order_mark(*text).size());
  return *std::move(text);
}

void for_each_row(const std::string& text,
                  const std::function<void(int line, std::span<const double> numbers)>& visit) {
  std::istringstream lines(text);
  std::string line, word;
  std::vector<double> numbers;
  for (int count = 1; std::getline(lines, line); ++count) {
    line.resize(std::min(line.size(), line.find('#')));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    std::istringstream words(line);
    numbers.clear();
    while (words >> word)
      numbers.push_back(number_of(word));
    if (!numbers.empty())
      visit(count, numbers);
  }
}

} // namespace keeler::files
