// extremes [--quick | --long] [--only NAME] [--write FILE]: measures all subjects but the longest two, or the quick
// ones, or the longest two, prints a line a row, and writes the page. Exit code 1 when a row does not hold.
#include "rows.hpp"

#include <fmt/format.h>

namespace keeler::extremes {
namespace {

std::string in_a_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

rows::Shown shown_row(const Row& row) {
  const rows::Verdict verdict = row.holds ? rows::Verdict::holds : rows::Verdict::fails;
  return {verdict,
          fmt::format("{}: {}, bound {}", row.what, row.measured, row.bound),
          {in_a_cell(row.what), in_a_cell(row.measured), in_a_cell(row.bound), row.why, name_of(verdict),
           fmt::format("`{}`", in_a_cell(row.made_by))}};
}

rows::Subject shown(const Subject& subject) {
  return {subject.name, subject.section, subject.length, [subject] {
            std::vector<rows::Shown> all;
            for (const Row& row : subject.measure())
              all.push_back(shown_row(row));
            return all;
          }};
}

std::vector<rows::Subject> all_subjects() {
  std::vector<rows::Subject> all;
  for (const auto& subjects : {orbit_subjects(), dense_subjects(), scale_subjects(), gravity_subjects(),
                               contact_subjects(), refusal_subjects(), long_subjects()})
    for (const Subject& subject : subjects)
      all.push_back(shown(subject));
  return all;
}

rows::Page page() {
  return {.head =
              "# Extremes\n\n"
              "What Keeler does where numbers are extreme, and which message it ends with where it refuses. Written "
              "by\n`scripts/test --extremes`, the sections called long by `scripts/test --extremes=long`; both "
              "measure all of it again.\nStarts have the seed of their scene (1) where the row names no other.\n",
          .columns = {"what", "measured", "bound", "why this bound", "verdict", "made by"},
          .tail = ""};
}

} // namespace
} // namespace keeler::extremes

int main(int count, char** words) {
  return keeler::rows::measure_rows(count, words, keeler::extremes::all_subjects(), keeler::extremes::page());
}
