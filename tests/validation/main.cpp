// validation [--quick] [--only NAME] [--write FILE]: measures all subjects, or the quick ones, prints a line a row, and
// writes the page. Exit code 1 when a row does not hold.
#include "rows.hpp"

#include <fmt/format.h>

#include <cmath>

namespace keeler::validation {

bool Row::holds() const {
  return std::fabs(measured - expected) <= tolerance;
}

namespace {

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

std::string measured(const Row& row) {
  return row.error > 0.0 ? fmt::format("{} ± {:.1g}", number(row.measured), row.error) : number(row.measured);
}

rows::Verdict verdict(const Row& row) {
  return row.holds()                    ? rows::Verdict::holds
         : row.known_difference.empty() ? rows::Verdict::fails
                                        : rows::Verdict::differs;
}

rows::Shown shown(const Row& row) {
  const std::string expected = fmt::format("{} ± {:.2g}", number(row.expected), row.tolerance);
  const std::string judged =
      row.holds() ? "holds" : fmt::format("**{}** {}", name_of(verdict(row)), row.known_difference);
  return {verdict(row),
          fmt::format("{}: {}, expected {} ({})", row.what, measured(row), expected, row.source),
          {row.what, measured(row), expected, row.tolerance_is, row.source, judged, fmt::format("`{}`", row.command)}};
}

rows::Subject shown(const Subject& subject) {
  return {subject.name, subject.section, subject.quick ? rows::Length::quick : rows::Length::usual, [subject] {
            std::vector<rows::Shown> all;
            for (const Row& row : subject.measure())
              all.push_back(shown(row));
            return all;
          }};
}

std::vector<rows::Subject> all_subjects() {
  std::vector<rows::Subject> all;
  for (const auto& subjects : {exact_subjects(), two_body_subjects(), balance_subjects(), literature_subjects(),
                               overstability_subjects(), fluid_wave_subjects(), particle_subjects(),
                               satellite_subjects(), moonlet_subjects(), light_subjects(), light_of_rings_subjects()})
    for (const Subject& subject : subjects)
      all.push_back(shown(subject));
  return all;
}

rows::Page page() {
  return {.head = "# Keeler against theory and literature\n\n"
                  "Written by `scripts/test --physics`, which measures all of it again. A row holds when the measured "
                  "value lies within the\ntolerance of the expected one; the error beside a measured value is its "
                  "statistical one. Runs have the seed of their scene\n(1) where the command names no other; box and "
                  "length stand in the scene or in the command.\n",
          .columns = {"what", "measured", "expected", "tolerance is", "source", "verdict", "made by"},
          .tail = R"(
## Not compared

- Of the light of Saturn's rings: the amplitude of the asymmetry at each elevation (French et al. 2007, their figures), phase curves with
  the surfaces' own opposition effect (Salo & French 2010), and scans of the unlit face (Porco et al. 2008).
)"};
}

} // namespace
} // namespace keeler::validation

int main(int count, char** words) {
  return keeler::rows::measure_rows(count, words, keeler::validation::all_subjects(), keeler::validation::page());
}
