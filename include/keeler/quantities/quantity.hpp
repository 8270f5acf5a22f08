// Quantities that Keeler reports: name, unit and meaning, declared once, next to the function that computes the value
// from typed results. Text, JSON, tables, pages, Python and the manual are views of them (views.hpp).
// docs/dev/quantities.md.
#pragma once

#include <keeler/statistics/measured.hpp>

#include <cassert>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace keeler::quantities {

/// A unit: the suffix of names, and the text for display. A pure number has neither.
struct Unit {
  std::string_view suffix; ///< "m2_s"; empty if names do not include it
  std::string_view text;   ///< "m²/s", UTF-8

  friend bool operator==(const Unit&, const Unit&) = default; ///< equal suffixes and texts
};

/// The units of Keeler's quantities.
namespace unit {
/// @{
/// A unit by its name; "per radius" and "per gravity" are natural units (PatchUnits).
inline constexpr Unit none{}, metres{"m", "m"}, metres_per_second{"m_s", "m/s"}, viscosity{"m2_s", "m²/s"},
    specific_energy{"m2_s2", "m²/s²"}, surface_density{"kg_m2", "kg/m²"}, degrees{"degrees", "degrees"},
    orbits{"orbits", "orbits"}, omega{"omega", "Ω"}, seconds{"s", "s"}, megabytes{"mb", "MB"},
    per_radius_speed{"r_omega", "r Ω"}, per_gravity_speed{"g_sigma_omega", "G Σ/Ω"},
    per_radius_viscosity{"r2_omega", "r² Ω"}, per_gravity_viscosity{"g2_sigma2_omega3", "G² Σ²/Ω³"};
/// @}

/// Returns a unit that is displayed but not part of the name.
inline constexpr Unit unnamed(std::string_view text) {
  return {"", text};
}
} // namespace unit

/// SI; natural units from ⟨r⟩ and Ω; natural units from G, Σ and Ω.
enum class UnitSystem { si, radius, gravity };

/// The natural units of a patch, in SI.
struct PatchUnits {
  double radius = 1.0;    ///< plain mean of the radii, m
  double frequency = 1.0; ///< Ω, rad/s
  double pull = 1.0;      ///< G Σ, m/s²

  double speed(UnitSystem system) const;     ///< 1, r Ω or G Σ/Ω; m/s
  double viscosity(UnitSystem system) const; ///< 1, r² Ω or G² Σ²/Ω³ (Daisaka, Tanaka & Ida 2001); m²/s
};

/// Returns the unit of a system that replaces `si`; only velocities and viscosities have another one.
Unit unit_in(const Unit& si, UnitSystem system);

/// Returns the size of that unit: numbers in `si` are divided by it.
double size_of_unit(const Unit& si, UnitSystem system, const PatchUnits& units);

/// Returns a text without characters that terminals may lack: "G^2 Sigma^2/Omega^3".
std::string ascii(std::string_view text);

/// The uncertainty given with a number: the standard error of a mean, or the standard deviation of single snapshots.
enum class Spread { none, error, scatter };

/// The systems of units in which JSON and tables give a number by default.
enum class Forms { si, si_and_radius, all };

/// The shape of a value. `truth` is yes or no. `other` (words, lists, several numbers that are not a vector) has no
/// column in tables.
enum class Shape { number, vector, truth, other };

/// A reported number or word: what it is called and what it means.
struct Quantity {
  std::string name;             ///< without its unit; "clusters.count" is `count` of the object `clusters`
  Unit unit{};                  ///< SI, or implied by the name
  std::string label{};          ///< for texts and pages; empty: not shown there by default
  std::string meaning{};        ///< with its source, for the manual
  Spread spread = Spread::none; ///< the uncertainty given with it
  Forms forms = Forms::si;      ///< systems of units by default
  int digits = 4;               ///< significant digits in texts
  Shape shape = Shape::number;  ///< of its value

  /// Returns the component of a vector along axis 0, 1 or 2, that is x, y or z: "dispersion_x".
  Quantity along(std::size_t axis) const;
  /// Returns the name with its unit: "total_viscosity_m2_s", "total_viscosity_r2_omega".
  std::string full_name(UnitSystem system = UnitSystem::si) const;
  /// Returns the name of the uncertainty: "total_viscosity_error_m2_s".
  std::string spread_name(UnitSystem system = UnitSystem::si) const;
  /// Returns true if `asked` is its name with or without unit, the name of its error, or of the object that contains
  /// it.
  bool is_called(const std::string& asked) const;
  /// Returns the systems of `forms`, or only `asked`.
  std::vector<UnitSystem> systems(std::optional<UnitSystem> asked = std::nullopt) const;
};

/// Returns the quantity with another shape.
Quantity of_shape(Quantity quantity, Shape shape);

/// Returns the quantity with another number of significant digits in texts.
Quantity of_digits(int digits, Quantity quantity);

/// Returns a quantity of shape `other`, without unit: a word, a list or an object.
Quantity word(const std::string& name, const std::string& label, const std::string& meaning);

/// Returns a quantity of shape `truth`.
Quantity yes_or_no(const std::string& name, const std::string& label, const std::string& meaning);

/// An unknown or missing value, and optionally the reason, as part of a sentence.
struct Unknown {
  std::string reason{}; ///< empty: not said
};

/// A number and its uncertainty (Quantity::spread).
struct Uncertain {
  double value = 0.0;             ///< the number
  std::optional<double> spread{}; ///< none if unknown
};

struct Record;

/// An object of numbers with names that depend on the results.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// The value of a quantity, in its unit. A list of records is a table.
using Value = std::variant<Unknown, bool, std::uint64_t, double, Uncertain, std::vector<double>, NamedNumbers,
                           std::string, std::vector<std::string>, std::vector<Record>>;

/// A quantity and its value.
struct Entry {
  Quantity quantity; ///< declares the value
  Value value;       ///< in the unit of the quantity
};

/// Numbers that belong together, in display order, and the natural units of their patch.
struct Record {
  std::vector<Entry> entries{}; ///< in display order
  PatchUnits units{};           ///< to convert from SI
  bool asked = false;           ///< requested by name: texts also show numbers without a label, and empty lists
};

/// Returns a value; a number that is not finite is unknown.
Value value_of(const std::optional<double>& number, const std::string& why_not = {});
/// As above, with the scatter.
Value value_of(const statistics::Measured& number, const std::string& why_not = {});
/// As above, with the standard error if it is finite.
Value value_of(const std::optional<Estimate>& number);

/// A quantity, and the function that computes its value from results.
template<class Source> struct QuantityRow {
  Quantity quantity;                         ///< declares the value
  std::function<Value(const Source&)> value; ///< computes it; a pointer to a member reads that member
  bool (*present)(const Source&) = nullptr;  ///< null: always
};

/// Returns the quantities that these results have, and their values.
template<class Source>
std::vector<Entry> entries_of(const std::vector<QuantityRow<Source>>& rows, const Source& source) {
  std::vector<Entry> entries;
  for (const QuantityRow<Source>& row : rows) {
    assert(row.value);
    if (!row.present || row.present(source))
      entries.push_back({row.quantity, row.value(source)});
  }
  return entries;
}

/// Returns the quantities of the rows.
template<class Source> std::vector<Quantity> quantities_of(const std::vector<QuantityRow<Source>>& rows) {
  std::vector<Quantity> all;
  for (const QuantityRow<Source>& row : rows)
    all.push_back(row.quantity);
  return all;
}

/// Returns the elements of both lists, in order.
template<class Element> std::vector<Element> joined(std::vector<Element> first, const std::vector<Element>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Returns the value of the quantity with that name, with or without its unit; null if there is none.
const Value* find_value(const Record& record, const std::string& name);

/// Returns the number with that name; none if it is missing, unknown or not a number.
std::optional<double> number_in(const Record& record, const std::string& name);

/// Returns the quantities of the entries.
std::vector<Quantity> quantities_of(const Record& record);

/// Throws UsageError for a name that matches none of the quantities (Quantity::is_called()).
void require_names(std::span<const Quantity> quantities, std::span<const std::string> names);

/// Returns the entries with the names, in the order of the names. Throws UsageError as require_names().
Record only(const Record& record, std::span<const std::string> names);

/// Returns the first quantity that matches the name; null if there is none.
const Quantity* find_quantity(std::span<const Quantity> quantities, const std::string& name);

} // namespace keeler::quantities
