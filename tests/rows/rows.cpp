#include "rows/rows.hpp"

#include <keeler/files/files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>

namespace keeler::rows {

std::string name_of(Verdict verdict) {
  return verdict == Verdict::holds ? "holds" : verdict == Verdict::differs ? "differs" : "fails";
}

namespace {

struct Options {
  bool quick = false, extra = false;
  std::vector<std::string> only; ///< empty: no names were given
  std::string page;

  bool selects(const Subject& subject) const {
    if (!only.empty())
      return std::find(only.begin(), only.end(), subject.name) != only.end();
    return quick ? subject.length == Length::quick : (subject.length == Length::extra) == extra;
  }
};

bool read_options(int count, char** words, Options& options) {
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--quick")
      options.quick = true;
    else if (word == "--long")
      options.extra = true;
    else if (word == "--only" && k + 1 < count)
      options.only.push_back(words[++k]);
    else if (word == "--write" && k + 1 < count)
      options.page = words[++k];
    else
      return false;
  }
  return !(options.quick && options.extra);
}

struct Section {
  std::vector<Shown> rows;
  bool whole = true; // all its subjects were measured
};
using Sections = std::map<std::string, Section>;

std::string table(const std::vector<std::string>& columns, const std::vector<Shown>& rows) {
  std::string text = fmt::format("| {} |\n|", fmt::join(columns, " | "));
  for (std::size_t k = 0; k < columns.size(); ++k)
    text += "---|";
  text += "\n";
  for (const Shown& row : rows)
    text += fmt::format("| {} |\n", fmt::join(row.cells, " | "));
  return text;
}

// What stands under a section's heading in a page; nothing where there is no such heading.
std::string section_of(const std::string& page, const std::string& name) {
  const std::string heading = fmt::format("\n## {}\n\n", name);
  const std::size_t start = page.find(heading);
  if (start == std::string::npos)
    return {};
  const std::size_t from = start + heading.size(), end = page.find("\n## ", from);
  return page.substr(from, end == std::string::npos ? end : end - from);
}

std::string written(const Page& page, const std::vector<Subject>& subjects, const Sections& measured,
                    const std::string& before) {
  std::string text = page.head, last;
  for (const Subject& subject : subjects) {
    if (subject.section == last)
      continue;
    last = subject.section;
    const auto found = measured.find(last);
    const bool renewed = found != measured.end() && found->second.whole;
    const std::string rows = renewed ? table(page.columns, found->second.rows) : section_of(before, last);
    if (!rows.empty())
      text += fmt::format("\n## {}\n\n{}", last, rows);
  }
  return text + page.tail;
}

std::vector<Shown> measure(const Subject& subject) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Shown> rows = subject.measure();
  for (const Shown& row : rows)
    fmt::print("{} {}\n", name_of(row.verdict), row.line);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  fmt::print("- {}: {:.1f} s\n", subject.name, took.count());
  std::fflush(stdout);
  return rows;
}

int measure_all(const Options& options, const std::vector<Subject>& subjects, const Page& page) {
  Sections sections;
  std::map<Verdict, int> counts;
  std::size_t found = 0;
  for (const Subject& subject : subjects) {
    Section& section = sections[subject.section];
    if (!options.selects(subject)) {
      section.whole = false;
      continue;
    }
    ++found;
    for (Shown& row : measure(subject)) {
      ++counts[row.verdict];
      section.rows.push_back(std::move(row));
    }
  }
  if (found < std::max<std::size_t>(options.only.size(), 1)) {
    fmt::print(stderr, "no such subject, or one named twice; the names are:\n");
    for (const Subject& subject : subjects)
      fmt::print(stderr, "  {}\n", subject.name);
    return 2;
  }
  if (!options.page.empty()) {
    const std::string before = std::filesystem::exists(options.page) ? files::read_text(options.page) : "";
    files::write_text(options.page, written(page, subjects, sections, before));
  }
  if (counts[Verdict::differs] > 0)
    fmt::print("{} differ for a known reason\n", counts[Verdict::differs]);
  fmt::print("{} passed, {} failed\n", counts[Verdict::holds] + counts[Verdict::differs], counts[Verdict::fails]);
  return counts[Verdict::fails] == 0 ? 0 : 1;
}

} // namespace

int measure_rows(int count, char** words, const std::vector<Subject>& subjects, const Page& page) {
  Options options;
  if (!read_options(count, words, options)) {
    fmt::print(stderr, "usage: {} [--quick | --long] [--only NAME]... [--write FILE]\n", words[0]);
    return 2;
  }
  try {
    return measure_all(options, subjects, page);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", words[0], error.what());
    return 1;
  }
}

} // namespace keeler::rows
