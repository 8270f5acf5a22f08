#include "rows.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keeler::extremes {
namespace {

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

Row row(const State& state, const std::string& what, double value, bool holds, const std::string& bound,
        const std::string& why) {
  return {fmt::format("{}: {}", state.name, what), number(value), bound, holds, why, state.made_by};
}

} // namespace

Row at_most(const State& state, const std::string& what, double value, double most, const std::string& why) {
  return row(state, what, value, value <= most, fmt::format("≤ {:.2g}", most), why);
}

Row at_least(const State& state, const std::string& what, double value, double least, const std::string& why) {
  return row(state, what, value, value >= least, "≥ " + number(least), why);
}

Row exactly(const State& state, const std::string& what, double value, double expected, const std::string& why) {
  return row(state, what, value, value == expected, number(expected), why);
}

Row refused(const State& state, const std::function<void()>& attempt, int code, const std::vector<std::string>& words) {
  Row result{state.name,
             "no error",
             fmt::format("exit {}; says \"{}\"", code, fmt::join(words, "\", \"")),
             false,
             "its message says why",
             state.made_by};
  try {
    attempt();
  } catch (const Error& error) {
    const std::string text = error.what();
    result.measured = text;
    result.holds = static_cast<int>(error.code()) == code &&
                   std::all_of(words.begin(), words.end(),
                               [&](const std::string& word) { return text.find(word) != std::string::npos; });
  }
  return result;
}

Row shown_by(const std::string& what, const std::string& file, const std::string& test_case, const std::string& why) {
  const std::string text = files::read_text(std::string(KEELER_SOURCE_DIR) + "/tests/unit/" + file);
  const bool there = text.find("TEST_CASE(\"" + test_case) != std::string::npos;
  return {what, there ? "a test of each build" : "there is no such test", "that test", there,
          why,  fmt::format("tests/unit/{}: {}", file, test_case)};
}

} // namespace keeler::extremes
