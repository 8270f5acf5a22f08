#include "text_files.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

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

double parse_radius(std::string_view word, const std::string& place) {
  double radius = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), radius);
  if (fault != std::errc{} || end != word.data() + word.size() || !std::isfinite(radius) || radius <= 0.0)
    throw UsageError(place + ": not a radius (every line is one number above 0, in m); correct this line");
  return radius;
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

std::vector<double> read_radii(const std::string& path, const std::string& place) {
  std::istringstream lines(read_text_file(path, place));
  std::vector<double> radii;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (const std::string_view word = trimmed(line); !word.empty())
      radii.push_back(parse_radius(word, fmt::format("{}:{}:1", path, number)));
  if (radii.empty())
    throw UsageError(
        fmt::format("{}: {} has no radius in it (it is empty or all comments); write one a line", place, path));
  return radii;
}

} // namespace keeler
