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

namespace keeler {
namespace {

double number_of(const std::string& word) {
  double number = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = fault == std::errc{} && end == word.data() + word.size();
  return whole ? number : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

std::string read_input(const std::filesystem::path& file, const std::string& place) {
  std::optional<std::string> text = content_of<std::string>(file);
  if (!text) {
    const std::string what = file == place ? "" : file.string() + " ";
    throw UsageError(fmt::format("{}: {}cannot be read ({}); check the path and its permissions", place, what,
                                 std::strerror(errno)));
  }
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

} // namespace keeler
