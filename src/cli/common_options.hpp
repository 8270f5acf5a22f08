// Options of several commands.
#pragma once

#include <keeler/core/format.hpp>
#include <keeler/core/start_threads.hpp>
#include <keeler/core/suggest.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/keys.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace keeler::cli {

/// Accepts numbers above 0 and up to `max`, with a shorter message than CLI11's check.
inline CLI::Validator positive_number(double max = std::numeric_limits<double>::infinity()) {
  assert(max > 0.0);
  const auto refusal = [max](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return *end == '\0' && end != text.c_str() && value > 0.0 && std::isfinite(value) && value <= max
               ? std::string()
               : "'" + text + "' is not a number above 0" + (std::isfinite(max) ? ", up to " + format_number(max) : "");
  };
  return CLI::Validator(refusal, "");
}

/// Accepts numbers from `low` to `high`, both included; `what` names the number in the message.
inline CLI::Validator number_between(double low, double high, const std::string& what) {
  assert(low <= high);
  const auto refusal = [=](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return *end == '\0' && end != text.c_str() && value >= low && value <= high
               ? std::string()
               : "'" + text + "' is not " + what + " from " + format_number(low) + " to " + format_number(high);
  };
  return CLI::Validator(refusal, "");
}

/// Accepts whole numbers from `low` to `high`, for an option's transform(): it passes 1e9 or 4.0, which CLI11 does not
/// read as integers, on in digits.
inline CLI::Validator whole_number_between(double low, double high, const std::string& what) {
  assert(low <= high);
  const auto digits_or_refusal = [=](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool number = *end == '\0' && end != text.c_str() && value >= low && value <= high;
    if (!number || value != std::trunc(value))
      return fmt::format("'{}' is not {} from {} to {}{}", text, what, format_number(low), format_number(high),
                         number ? "; give a whole number" : "");
    text = fmt::format("{:.0f}", value);
    return std::string();
  };
  return CLI::Validator(digits_or_refusal, "");
}

/// Accept numbers of particles of a run, of repeats of a measurement, and of threads.
inline CLI::Validator particle_number() {
  return whole_number_between(1, scene::find_key("particles.count")->range.high, "a number of particles");
}
inline CLI::Validator repeat_number() {
  return whole_number_between(1, 1000, "a number of repeats");
}
inline CLI::Validator thread_number() {
  return whole_number_between(1, max_threads, "a number of threads");
}

inline constexpr double max_orbits = 1e6;   ///< of a probe or a run of a study
inline constexpr double max_seeds = 1000.0; ///< of a study

/// Restricts an option to these words, which --help lists and the shell completes.
inline CLI::Option& one_of(CLI::Option* option, const std::vector<std::string>& words) {
  assert(option && !words.empty());
  const auto refusal = [words](const std::string& word) {
    if (std::find(words.begin(), words.end(), word) != words.end())
      return std::string();
    const std::string near = closest(word, words);
    return fmt::format("'{}' is none of {}", word, fmt::join(words, ", ")) +
           (near.empty() ? "" : "; did you mean '" + near + "'?");
  };
  option->type_name(fmt::format("{}", fmt::join(words, "|")))->check(CLI::Validator(refusal, ""));
  return *option;
}

/// Adds --quantities NAME,…: columns of a table of runs.
inline void add_quantities(CLI::App& command, std::vector<std::string>& names) {
  command
      .add_option("--quantities", names,
                  "further columns: numbers of a run, separated by commas (\"keeler help numbers\" lists them)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
}

/// --threads N.
struct ThreadOption {
  int count = 0; ///< 0: all threads of the machine

  void add_to(CLI::App& command) {
    command.add_option("--threads", count, "threads to use (default: all); the results do not depend on the number")
        ->transform(thread_number());
  }

  void apply() const {
    if (count > 0)
      set_threads(count);
    start_threads();
  }
};

} // namespace keeler::cli
