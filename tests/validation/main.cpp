// validation [--quick] [--only NAME] [--write FILE]: measures all subjects, or the quick ones, prints a line a row, and
// writes the page. Exit code 1 when a row does not hold.
#include "rows.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/words.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <map>

namespace keeler::validation {

bool Row::holds() const {
  return std::fabs(measured - expected) <= tolerance;
}

namespace {

struct Options {
  bool quick = false;
  std::string only, page;
};

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

std::string measured(const Row& row) {
  return row.error > 0.0 ? fmt::format("{} ± {:.1g}", number(row.measured), row.error) : number(row.measured);
}

std::string verdict(const Row& row) {
  return row.holds() ? "holds" : row.known_difference.empty() ? "fails" : "differs";
}

void print(const Row& row) {
  fmt::print("{} {}: {}, expected {} ± {:.2g} ({})\n", verdict(row), row.what, measured(row), number(row.expected),
             row.tolerance, row.source);
  std::fflush(stdout);
}

std::string page_row(const Row& row) {
  return fmt::format("| {} | {} | {} ± {:.2g} | {} | {} | {} | `{}` |\n", row.what, measured(row), number(row.expected),
                     row.tolerance, row.tolerance_is, row.source,
                     row.holds() ? "holds" : fmt::format("**{}** {}", verdict(row), row.known_difference), row.command);
}

std::string page(const std::vector<std::pair<std::string, std::vector<Row>>>& sections) {
  std::string text =
      "# Keeler against theory and literature\n\n"
      "Written by `scripts/test --physics`, which measures all of it again. A row holds when the measured "
      "value lies within the\ntolerance of the expected one; the error beside a measured value is its "
      "statistical one. Runs have the seed of their scene\n(1) where the command names no other; box and "
      "length stand in the scene or in the command.\n";
  for (const auto& [section, rows] : sections) {
    text += fmt::format("\n## {}\n\n| what | measured | expected | tolerance is | source | verdict | made by |\n"
                        "|---|---|---|---|---|---|---|\n",
                        section);
    for (const Row& row : rows)
      text += page_row(row);
  }
  return text + R"(
## Not compared

- The brightness asymmetry of Saturn's A ring in images (French et al. 2007): it needs scattered light.
)";
}

int measure(const Options& options) {
  std::vector<std::pair<std::string, std::vector<Row>>> sections;
  int held = 0, different = 0, failed = 0;
  for (const auto& subjects : {exact_subjects(), two_body_subjects(), balance_subjects(), literature_subjects(),
                               overstability_subjects()})
    for (const Subject& subject : subjects) {
      if ((options.quick && !subject.quick) || (!options.only.empty() && subject.name != options.only))
        continue;
      const std::vector<Row> rows = subject.measure();
      for (const Row& row : rows) {
        print(row);
        ++(row.holds() ? held : verdict(row) == "differs" ? different : failed);
      }
      if (sections.empty() || sections.back().first != subject.section)
        sections.push_back({subject.section, {}});
      sections.back().second.insert(sections.back().second.end(), rows.begin(), rows.end());
    }
  if (sections.empty()) {
    fmt::print(stderr, "validation: no subject is called {}\n", options.only);
    return 2;
  }
  if (!options.page.empty())
    write_text(options.page, page(sections));
  if (different > 0)
    fmt::print("{} differ from the literature for a known reason\n", different);
  fmt::print("{} passed, {} failed\n", held + different, failed);
  return failed == 0 ? 0 : 1;
}

} // namespace
} // namespace keeler::validation

int main(int count, char** words) {
  keeler::validation::Options options;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--quick")
      options.quick = true;
    else if (word == "--only" && k + 1 < count)
      options.only = words[++k];
    else if (word == "--write" && k + 1 < count)
      options.page = words[++k];
    else {
      fmt::print(stderr, "usage: validation [--quick] [--only NAME] [--write FILE]\n");
      return 2;
    }
  }
  try {
    return keeler::validation::measure(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "validation: {}\n", error.what());
    return 1;
  }
}
