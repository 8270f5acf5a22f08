// Which numbers a command tells, and in which units.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// --only NAME,… and --units SYSTEM.
class NumberOptions {
public:
  void add_to(CLI::App& command);

  /// None: those that each number has by default.
  std::optional<UnitSystem> system() const;

  /// Before anything is measured. Throws UsageError for a name that none of the quantities has.
  void check(std::span<const Quantity> quantities) const { require_names(quantities, names_); }

  /// All, or the ones that are named. Throws UsageError for a name that the record does not have.
  Record chosen(const Record& record) const { return names_.empty() ? record : only(record, names_); }

private:
  std::vector<std::string> names_;
  std::string system_;
};

} // namespace keeler
