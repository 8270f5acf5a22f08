// How records are shown: JSON, rows of CSV, text for terminals, tables of pages and of the manual.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <nlohmann/json.hpp>

namespace keeler {

/// Null where it is not known or not finite.
nlohmann::ordered_json or_null(const std::optional<double>& number);

/// An object; names with a dot are objects in it, and what is not known is null.
nlohmann::ordered_json json_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// What json_of() made of a record: numbers, words and lists of words. Quantities that the JSON does not have are left
/// out; what it has besides is there under its name alone. Throws UsageError for a value of another kind.
Record record_of(const nlohmann::ordered_json& json, std::span<const Quantity> quantities);

/// A row of a table with a column for each plain number: a vector has one for each axis ("dispersion_x_m_s"), what is
/// not known is null, and lists, errors and scatters are left out.
nlohmann::ordered_json row_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// "0.00146 ± 0.0002 m/s = 2.5 r Ω", in the systems of the quantity, or in the one asked for.
std::string text_of(const Entry& entry, const PatchUnits& units, std::optional<UnitSystem> system = std::nullopt);

/// For terminals: a line for each number that has a label, and for each record of a list.
std::string lines_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// Rows (label, value with unit) of those with a label.
std::vector<std::vector<std::string>> table_of(const Record& record);

/// As a Markdown table: name, unit, meaning.
std::string markdown_of(std::span<const Quantity> quantities);

} // namespace keeler
