// Keeler where numbers are extreme: the rows of docs/trade-offs/extremes.md.
#pragma once

#include "rows/rows.hpp"

#include <functional>
#include <string>
#include <vector>

namespace keeler::extremes {

/// What was measured, and within which bound it must lie.
struct Row {
  std::string what, measured, bound;
  bool holds = false;
  std::string why;     ///< that bound
  std::string made_by; ///< the command or the state, with seed and length
};

/// What the rows of one state have in common.
struct State {
  std::string name, made_by;
};

Row at_most(const State& state, const std::string& what, double value, double most, const std::string& why);
Row at_least(const State& state, const std::string& what, double value, double least, const std::string& why);
Row exactly(const State& state, const std::string& what, double value, double expected, const std::string& why);

/// The attempt must end in a keeler::Error with this exit code, whose message has all these words.
Row refused(const State& state, const std::function<void()>& attempt, int code, const std::vector<std::string>& words);

/// What a test case of tests/unit shows already; it must be there.
Row shown_by(const std::string& what, const std::string& file, const std::string& test_case, const std::string& why);

struct Subject {
  std::string name, section;
  rows::Length length;
  std::function<std::vector<Row>()> measure;
};

std::vector<Subject> orbit_subjects();
std::vector<Subject> dense_subjects();
std::vector<Subject> scale_subjects();
std::vector<Subject> gravity_subjects();
std::vector<Subject> contact_subjects();
std::vector<Subject> refusal_subjects();
std::vector<Subject> long_subjects();

} // namespace keeler::extremes
