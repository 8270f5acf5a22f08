// A program of rows: it measures subjects, prints a line a row, and writes a page with a table a section. What a row
// is, and when it holds, is the program's own.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace keeler::rows {

enum class Verdict { holds, differs, fails }; ///< differs: it does not hold, for a known reason

std::string name_of(Verdict verdict);

/// A row as it is shown.
struct Shown {
  Verdict verdict = Verdict::fails;
  std::string line;               ///< printed behind the verdict
  std::vector<std::string> cells; ///< of the page, one for each column
};

enum class Length { quick, usual, extra };

/// What is measured together.
struct Subject {
  std::string name;    ///< for --only
  std::string section; ///< of the page
  Length length = Length::usual;
  std::function<std::vector<Shown>()> measure;
};

struct Page {
  std::string head; ///< before the first section
  std::vector<std::string> columns;
  std::string tail; ///< after the last one
};

/// NAME [--quick | --long] [--only SUBJECT]... [--write FILE]: measures the quick subjects, the extra ones, or all but
/// these; or the subjects that are named. Sections of the page of which not all was measured stay as they are in the
/// file. Returns the exit code: 1 when a row fails, 2 for a wrong command line.
int measure_rows(int count, char** words, const std::vector<Subject>& subjects, const Page& page);

} // namespace keeler::rows
