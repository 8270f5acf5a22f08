#include <keeler/quantities/views.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace keeler::quantities {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t label_width = 34;

template<class... Cases> struct Overloaded : Cases... { using Cases::operator()...; };
template<class... Cases> Overloaded(Cases...) -> Overloaded<Cases...>;

// Returns the value in a unit of this size.
Value in_units(const Value& value, double size) {
  return std::visit(Overloaded{[&](double number) { return Value(number / size); },
                               [&](const Uncertain& number) {
                                 return Value(Uncertain{number.value / size, number.spread
                                                                                 ? std::optional(*number.spread / size)
                                                                                 : std::nullopt});
                               },
                               [&](std::vector<double> numbers) {
                                 for (double& number : numbers)
                                   number /= size;
                                 return Value(std::move(numbers));
                               },
                               [](const auto& other) { return Value(other); }},
                    value);
}

Json json_of(const Value& value) {
  return std::visit(Overloaded{[](const Unknown&) { return Json(nullptr); },
                               [](double number) { return or_null(number); },
                               [](const Uncertain& number) { return or_null(number.value); },
                               [](const NamedNumbers& numbers) {
                                 Json object = Json::object();
                                 for (const auto& [name, number] : numbers)
                                   object[name] = or_null(number);
                                 return object;
                               },
                               [](const std::vector<Record>& records) {
                                 Json list = Json::array();
                                 for (const Record& record : records)
                                   list.push_back(quantities::json_of(record));
                                 return list;
                               },
                               [](const auto& other) { return Json(other); }},
                    value);
}

// Returns json["clusters"]["count"] for "clusters.count".
Json& element_at(Json& json, const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? json[name] : element_at(json[name.substr(0, dot)], name.substr(dot + 1));
}

// Returns the element with a dotted name; null if there is none.
const Json* find_part(const Json& json, const std::string& name) {
  if (json.is_null())
    return nullptr;
  if (!json.is_object())
    throw UsageError(fmt::format("'{}' cannot be read from a value that is not an object", name));
  const std::size_t dot = name.find('.');
  const auto part = json.find(name.substr(0, dot));
  if (part == json.end())
    return nullptr;
  return dot == std::string::npos ? &*part : find_part(*part, name.substr(dot + 1));
}

bool has_parts(std::span<const Quantity> quantities, const std::string& name) {
  return std::any_of(quantities.begin(), quantities.end(),
                     [&](const Quantity& quantity) { return quantity.name.starts_with(name + "."); });
}

Value read_value(const Json& json, const Quantity& quantity) {
  if (json.is_null())
    return Unknown{};
  if (json.is_number_unsigned())
    return json.get<std::uint64_t>();
  if (json.is_number())
    return json.get<double>();
  if (quantity.shape == Shape::number)
    throw UsageError(fmt::format("'{}' is not a number", quantity.full_name()));
  if (json.is_boolean())
    return json.get<bool>();
  if (json.is_string())
    return json.get<std::string>();
  std::vector<std::string> texts;
  NamedNumbers numbers;
  for (const auto& [name, value] : json.items())
    if (value.is_string())
      texts.push_back(value.get<std::string>());
    else if (value.is_number())
      numbers.emplace_back(name, value.get<double>());
  return json.is_array() ? Value(texts) : Value(numbers);
}

// Adds elements that match no known quantity, under their names.
void add_others(Record& record, const Json& json, const std::string& object, const std::set<std::string>& known) {
  for (const auto& [name, value] : json.items()) {
    const std::string path = object + name;
    if (known.contains(path))
      continue;
    if (value.is_object())
      add_others(record, value, path + ".", known);
    else if (!value.is_null())
      record.entries.push_back({word(path, "", ""), read_value(value, word(path, "", ""))});
  }
}

std::string text_of(const Value& value, int digits) {
  assert(digits > 0);
  return std::visit(
      Overloaded{[](const Unknown& unknown) {
                   return unknown.reason.empty() ? std::string("none") : "not known because " + unknown.reason;
                 },
                 [](bool yes) { return std::string(yes ? "yes" : "no"); },
                 [](std::uint64_t count) { return fmt::format("{}", count); },
                 [&](double number) { return format_number(number, digits); },
                 [&](const Uncertain& number) {
                   return format_number(number.value, digits) +
                          (number.spread ? fmt::format(" ± {}", format_number(*number.spread, 2)) : std::string());
                 },
                 [&](const std::vector<double>& numbers) {
                   std::vector<std::string> texts;
                   for (const double number : numbers)
                     texts.push_back(format_number(number, digits));
                   return fmt::format("{}", fmt::join(texts, " "));
                 },
                 [&](const NamedNumbers& numbers) {
                   std::vector<std::string> texts;
                   for (const auto& [name, number] : numbers)
                     texts.push_back(fmt::format("{} {}", name, format_number(number, digits)));
                   return fmt::format("{}", fmt::join(texts, ", "));
                 },
                 [](const std::string& text) { return text; },
                 [](const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, "; ")); },
                 [](const std::vector<Record>& records) { return fmt::format("{}", records.size()); }},
      value);
}

const std::string& label_of(const Quantity& quantity) {
  return quantity.label.empty() ? quantity.name : quantity.label;
}

// "wavelength 60 m, density amplitude 0.02".
std::string inline_text(const Record& record, std::optional<UnitSystem> system) {
  std::string all;
  for (const Entry& entry : record.entries)
    all +=
        fmt::format("{}{} {}", all.empty() ? "" : ", ", label_of(entry.quantity), text_of(entry, record.units, system));
  return all;
}

struct TextRow {
  std::string label, text;
  bool is_sentence = false;
};

// Returns one row per entry, or per record or sentence of a list.
std::vector<TextRow> rows_of(const Record& record, std::optional<UnitSystem> system) {
  std::vector<TextRow> rows;
  for (const auto& [quantity, value] : record.entries) {
    if (quantity.label.empty() && !record.asked)
      continue;
    const std::size_t before = rows.size();
    const auto* const records = std::get_if<std::vector<Record>>(&value);
    const auto* const sentences = std::get_if<std::vector<std::string>>(&value);
    if (records)
      for (const Record& one : *records)
        rows.push_back({label_of(quantity), inline_text(one, system)});
    else if (sentences)
      for (const std::string& sentence : *sentences)
        rows.push_back({label_of(quantity), sentence, true});
    else
      rows.push_back({label_of(quantity), text_of({quantity, value}, record.units, system)});
    if (rows.size() == before && record.asked)
      rows.push_back({label_of(quantity), "none"});
  }
  return rows;
}

// Returns a long time also in minutes or hours: " = 7.2 min".
std::string in_hours(const Value& value, const Unit& unit) {
  const auto* const seconds = std::get_if<double>(&value);
  if (unit != unit::seconds || !seconds || *seconds < 120.0)
    return {};
  return *seconds < 7200.0 ? fmt::format(" = {} min", format_number(*seconds / 60.0, 2))
                           : fmt::format(" = {} h", format_number(*seconds / 3600.0, 2));
}

// A number under one of its names: one per system of units, and its error or scatter once.
struct NamedValue {
  std::string name;
  Value value; // never Uncertain
};

std::vector<NamedValue> named_values(const Entry& entry, const PatchUnits& units, std::optional<UnitSystem> system) {
  const Quantity& quantity = entry.quantity;
  std::vector<NamedValue> all;
  bool with_spread = quantity.spread != Spread::none; // in the first system only
  for (const UnitSystem in : quantity.systems(system)) {
    const Value value = in_units(entry.value, size_of_unit(quantity.unit, in, units));
    const auto* const uncertain = std::get_if<Uncertain>(&value);
    all.push_back({quantity.full_name(in), uncertain ? Value(uncertain->value) : value});
    if (with_spread)
      all.push_back({quantity.spread_name(in), value_of(uncertain ? uncertain->spread : std::nullopt)});
    with_spread = false;
  }
  return all;
}

} // namespace

Json or_null(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

Json json_of(const Record& record, std::optional<UnitSystem> system) {
  Json json = Json::object();
  for (const Entry& entry : record.entries)
    for (const NamedValue& named : named_values(entry, record.units, system))
      element_at(json, named.name) = json_of(named.value);
  return json;
}

Record record_of(const Json& json, std::span<const Quantity> quantities) {
  Record record;
  std::set<std::string> known;
  for (const Quantity& quantity : quantities) {
    const std::string name = quantity.full_name();
    const Json* const value = find_part(json, name);
    if (!value || (value->is_object() && has_parts(quantities, name)))
      continue;
    known.insert(name);
    record.entries.push_back({quantity, read_value(*value, quantity)});
  }
  add_others(record, json, "", known);
  return record;
}

Json row_of(const Record& record, std::optional<UnitSystem> system) {
  Json row;
  for (const Entry& entry : record.entries)
    for (const UnitSystem in : entry.quantity.systems(system)) {
      const Value value = in_units(entry.value, size_of_unit(entry.quantity.unit, in, record.units));
      const auto* const vector = std::get_if<std::vector<double>>(&value);
      if (vector && vector->size() == 3) {
        for (std::size_t k = 0; k < vector->size(); ++k)
          row[entry.quantity.along(k).full_name(in)] = (*vector)[k];
      } else if (const Json plain = json_of(value); plain.is_primitive()) {
        row[entry.quantity.full_name(in)] = plain;
      }
    }
  return row;
}

std::string text_of(const Entry& entry, const PatchUnits& units, std::optional<UnitSystem> system) {
  const Quantity& quantity = entry.quantity;
  if (std::holds_alternative<Unknown>(entry.value))
    return text_of(entry.value, quantity.digits);
  std::string all;
  for (const UnitSystem in : quantity.systems(system)) {
    Value value = in_units(entry.value, size_of_unit(quantity.unit, in, units));
    if (const auto* const uncertain = std::get_if<Uncertain>(&value); uncertain && !all.empty())
      value = uncertain->value; // the error is given once
    const std::string_view name = unit_in(quantity.unit, in).text;
    all += fmt::format("{}{}{}{}{}", all.empty() ? "" : " = ", text_of(value, quantity.digits), name.empty() ? "" : " ",
                       name, in_hours(value, quantity.unit));
  }
  return all;
}

std::string lines_of(const Record& record, std::optional<UnitSystem> system) {
  std::string lines;
  for (const TextRow& row : rows_of(record, system))
    lines += row.is_sentence ? fmt::format("{}: {}\n", ascii(row.label), ascii(row.text))
                             : fmt::format("{:<{}} {}\n", ascii(row.label), label_width, ascii(row.text));
  return lines;
}

std::vector<std::vector<std::string>> table_of(const Record& record, std::optional<UnitSystem> system) {
  std::vector<std::vector<std::string>> rows;
  for (const TextRow& row : rows_of(record, system))
    rows.push_back({row.label, row.text});
  return rows;
}

std::string markdown_of(std::span<const Quantity> quantities) {
  std::string table = "| name | unit | meaning |\n|---|---|---|\n";
  for (const Quantity& quantity : quantities) {
    std::string names;
    for (const UnitSystem system : quantity.systems()) {
      names += fmt::format("{}`{}`", names.empty() ? "" : ", ", quantity.full_name(system));
      if (system == UnitSystem::si && quantity.spread != Spread::none)
        names += fmt::format(", `{}`", quantity.spread_name());
    }
    assert(quantity.meaning.find('|') == std::string::npos);
    table += fmt::format("| {} | {} | {} |\n", names, quantity.unit.text, quantity.meaning);
  }
  return table;
}

} // namespace keeler::quantities
