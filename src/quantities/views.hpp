// Views of records: JSON, rows of CSV, text for terminals, tables of pages and of the manual.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <nlohmann/json.hpp>

namespace keeler::quantities {

/// Returns null if the number is missing or not finite.
nlohmann::ordered_json or_null(const std::optional<double>& number);

/// Returns an object. Names with a dot become nested objects, unknown values null.
nlohmann::ordered_json json_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// Reads back a record from json_of(): numbers, words and lists of words. Quantities missing in the JSON are omitted;
/// unknown names become entries without unit and label. Throws UsageError for a value of another type.
Record record_of(const nlohmann::ordered_json& json, std::span<const Quantity> quantities);

/// Returns a row of a table with a column per plain number: a vector has one per axis ("dispersion_x_m_s"), unknown
/// numbers are null, and lists, errors and scatters are omitted.
nlohmann::ordered_json row_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// Returns "0.00146 ± 0.0002 m/s = 2.5 r Ω", in the systems of the quantity, or only in `system`.
std::string text_of(const Entry& entry, const PatchUnits& units, std::optional<UnitSystem> system = std::nullopt);

/// Returns text for terminals: one line per number with a label, and per record of a list.
std::string lines_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// Returns rows (label, value with unit) of the entries with a label.
std::vector<std::vector<std::string>> table_of(const Record& record, std::optional<UnitSystem> system = std::nullopt);

/// Returns a Markdown table: name, unit, meaning.
std::string markdown_of(std::span<const Quantity> quantities);

} // namespace keeler::quantities
