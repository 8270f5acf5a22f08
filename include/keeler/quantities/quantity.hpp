// A number that Keeler reports: what it is called, its unit and what it means, said once, beside how it is read from
// typed results. Text, JSON, tables, pages, Python and the manual are views of it (views.hpp). docs/dev/quantities.md.
#pragma once

#include <keeler/quantities/unit.hpp>
#include <keeler/statistics/measured.hpp>
#include <keeler/statistics/time_series.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace keeler {

/// What stands beside a number: the standard error of a mean, or the standard deviation of single snapshots.
enum class Spread { none, error, scatter };

/// In which systems of units JSON and tables give a number where nothing is asked for.
enum class Forms { si, si_and_radius, all };

/// Several numbers that are no vector, words and lists have no column of a table.
enum class Shape { number, vector, other };

struct Quantity {
  std::string name;    ///< without its unit; "clusters.count" is `count` of the object `clusters`
  Unit unit{};         ///< SI, or what the name says
  std::string label{}; ///< for texts and pages; empty: only under its name
  std::string meaning{};
  Spread spread = Spread::none;
  Forms forms = Forms::si;
  int digits = 4; ///< significant ones in texts
  Shape shape = Shape::number;

  /// The component of a vector along x, y or z: "dispersion_x".
  Quantity along(std::size_t axis) const;
  /// "total_viscosity_m2_s", "total_viscosity_r2_omega".
  std::string full_name(UnitSystem system = UnitSystem::si) const;
  /// "total_viscosity_error_m2_s".
  std::string spread_name(UnitSystem system = UnitSystem::si) const;
  /// Whether it has the name: full, without its unit, that of its error, or that of the object which holds it.
  bool is_called(const std::string& asked) const;
  /// The systems of `forms`, or the one that is asked for.
  std::vector<UnitSystem> systems(std::optional<UnitSystem> asked = std::nullopt) const;
};

/// A quantity that is no plain number.
Quantity of_shape(Quantity quantity, Shape shape);

/// A word, yes or no, a list or an object.
Quantity word(const std::string& name, const std::string& label, const std::string& meaning);

/// Not known or not there, and why: a part of a sentence, or nothing.
struct Unknown {
  std::string reason{};
};

/// A number and what its quantity has beside it.
struct Uncertain {
  double value = 0.0;
  std::optional<double> spread{};
};

struct Record;

/// Numbers under names that only the results know: an object.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

using Value = std::variant<Unknown, bool, std::uint64_t, double, Uncertain, std::vector<double>, NamedNumbers,
                           std::string, std::vector<std::string>, std::vector<Record>>;

struct Entry {
  Quantity quantity;
  Value value;
};

/// Numbers that belong together, in the order in which they are shown, and the units of the patch that they are of.
struct Record {
  std::vector<Entry> entries{};
  PatchUnits units{};
  bool asked = false; ///< for by name: texts then tell numbers without a label and empty lists too
};

/// A number that is not finite is not known.
Value value_of(const std::optional<double>& number, const std::string& why_not = {});
Value value_of(const Measured& number, const std::string& why_not = {});
Value value_of(const std::optional<Estimate>& number);

/// A quantity, and how it is read from results.
template<class Source> struct QuantityRow {
  Quantity quantity;
  Value (*value)(const Source&);
  bool (*present)(const Source&) = nullptr; ///< null: always
};

template<class Source>
std::vector<Entry> entries_of(const std::vector<QuantityRow<Source>>& rows, const Source& source) {
  std::vector<Entry> entries;
  for (const QuantityRow<Source>& row : rows)
    if (!row.present || row.present(source))
      entries.push_back({row.quantity, row.value(source)});
  return entries;
}

template<class Source> std::vector<Quantity> quantities_of(const std::vector<QuantityRow<Source>>& rows) {
  std::vector<Quantity> all;
  for (const QuantityRow<Source>& row : rows)
    all.push_back(row.quantity);
  return all;
}

template<class Element> std::vector<Element> joined(std::vector<Element> first, const std::vector<Element>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// The value of the quantity of that name, with or without its unit; null where the record has none.
const Value* find_value(const Record& record, const std::string& name);

/// The number of that name; none where it is not there, not known or no number.
std::optional<double> number_in(const Record& record, const std::string& name);

std::vector<Quantity> quantities_of(const Record& record);

/// Throws UsageError for a name that none of the quantities has (Quantity::is_called()).
void require_names(std::span<const Quantity> quantities, std::span<const std::string> names);

/// The entries that are named so, in the order of the names. Throws UsageError as require_names().
Record only(const Record& record, std::span<const std::string> names);

/// The first quantity of that name; null where there is none.
const Quantity* find_quantity(std::span<const Quantity> quantities, const std::string& name);

} // namespace keeler
