#include <keeler/quantities/quantity.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/suggest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::quantities {
namespace {

std::string joined(const std::string& name, std::string_view suffix) {
  return suffix.empty() ? name : fmt::format("{}_{}", name, suffix);
}

constexpr UnitSystem all_systems[] = {UnitSystem::si, UnitSystem::radius, UnitSystem::gravity};

} // namespace

Quantity Quantity::along(std::size_t axis) const {
  assert(axis < 3);
  Quantity component = of_shape(*this, Shape::number);
  component.name += fmt::format("_{}", "xyz"[axis]);
  return component;
}

std::string Quantity::full_name(UnitSystem system) const {
  return joined(name, unit_in(unit, system).suffix);
}

std::string Quantity::spread_name(UnitSystem system) const {
  return joined(name + (spread == Spread::scatter ? "_scatter" : "_error"), unit_in(unit, system).suffix);
}

std::vector<UnitSystem> Quantity::systems(std::optional<UnitSystem> asked) const {
  if (asked)
    return {*asked};
  return {std::begin(all_systems), std::begin(all_systems) + static_cast<int>(forms) + 1};
}

bool Quantity::is_called(const std::string& asked) const {
  return name == asked || name.starts_with(asked + ".") ||
         std::any_of(std::begin(all_systems), std::end(all_systems), [&](UnitSystem system) {
           return full_name(system) == asked || (spread != Spread::none && spread_name(system) == asked);
         });
}

Quantity of_shape(Quantity quantity, Shape shape) {
  quantity.shape = shape;
  return quantity;
}

Quantity of_digits(int digits, Quantity quantity) {
  assert(digits > 0);
  quantity.digits = digits;
  return quantity;
}

Quantity word(const std::string& name, const std::string& label, const std::string& meaning) {
  return of_shape({name, unit::none, label, meaning}, Shape::other);
}

Quantity yes_or_no(const std::string& name, const std::string& label, const std::string& meaning) {
  return of_shape({name, unit::none, label, meaning}, Shape::truth);
}

Value value_of(const std::optional<double>& number, const std::string& why_not) {
  return number && std::isfinite(*number) ? Value(*number) : Value(Unknown{why_not});
}

Value value_of(const statistics::Measured& number, const std::string& why_not) {
  return number.value ? Value(Uncertain{*number.value, number.scatter}) : Value(Unknown{why_not});
}

Value value_of(const std::optional<Estimate>& number) {
  if (!number || !std::isfinite(number->value))
    return Unknown{};
  return Uncertain{number->value, std::isfinite(number->error) ? std::optional(number->error) : std::nullopt};
}

void require_names(std::span<const Quantity> quantities, std::span<const std::string> names) {
  for (const std::string& name : names) {
    if (find_quantity(quantities, name))
      continue;
    std::vector<std::string> known;
    for (const Quantity& quantity : quantities)
      known.insert(known.end(), {quantity.name, quantity.full_name()});
    const std::string near = closest(name, known);
    throw UsageError(
        fmt::format("there is no number '{}' here; {}", name,
                    near.empty() ? "\"keeler help numbers\" lists them, and says which depend on settings of the scene"
                                 : fmt::format("did you mean '{}'?", near)));
  }
}

Record only(const Record& record, std::span<const std::string> names) {
  require_names(quantities_of(record), names);
  Record chosen{{}, record.units, true};
  for (const std::string& name : names)
    for (const Entry& entry : record.entries)
      if (entry.quantity.is_called(name))
        chosen.entries.push_back(entry);
  return chosen;
}

const Value* find_value(const Record& record, const std::string& name) {
  const auto found = std::find_if(record.entries.begin(), record.entries.end(), [&](const Entry& entry) {
    return entry.quantity.name == name || entry.quantity.full_name() == name;
  });
  return found == record.entries.end() ? nullptr : &found->value;
}

std::optional<double> number_in(const Record& record, const std::string& name) {
  const Value* const value = find_value(record, name);
  if (const auto* const number = value ? std::get_if<double>(value) : nullptr)
    return *number;
  if (const auto* const count = value ? std::get_if<std::uint64_t>(value) : nullptr)
    return static_cast<double>(*count);
  if (const auto* const uncertain = value ? std::get_if<Uncertain>(value) : nullptr)
    return uncertain->value;
  return std::nullopt;
}

std::vector<Quantity> quantities_of(const Record& record) {
  std::vector<Quantity> all;
  for (const Entry& entry : record.entries)
    all.push_back(entry.quantity);
  return all;
}

const Quantity* find_quantity(std::span<const Quantity> quantities, const std::string& name) {
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [&](const Quantity& quantity) { return quantity.is_called(name); });
  return found == quantities.end() ? nullptr : &*found;
}

} // namespace keeler::quantities
