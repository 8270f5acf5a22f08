// Options that select the printed numbers and their units.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::cli {

/// --units SYSTEM.
class UnitsOption {
public:
  void add_to(CLI::App& command);

  /// Returns the requested units; none: the default units of each number.
  std::optional<quantities::UnitSystem> system() const;

private:
  std::string system_;
};

/// --only NAME,… and --units SYSTEM.
class NumberOptions {
public:
  void add_to(CLI::App& command);

  std::optional<quantities::UnitSystem> system() const { return units_.system(); }

  /// Checks the names before anything is measured. Throws UsageError for a name that none of the quantities has.
  void check(std::span<const quantities::Quantity> quantities) const { require_names(quantities, names_); }

  /// Returns all numbers, or the requested ones. Throws UsageError for a name that the record does not have.
  quantities::Record chosen(const quantities::Record& record) const {
    return names_.empty() ? record : only(record, names_);
  }

private:
  std::vector<std::string> names_;
  UnitsOption units_;
};

} // namespace keeler::cli
