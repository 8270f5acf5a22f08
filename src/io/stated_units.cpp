#include "stated_units.hpp"

#include "formats.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace keeler::io {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::string without_blanks(const std::string& text) {
  std::string letters;
  for (const char c : text)
    if (c != ' ')
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

// A unit, its spellings by yt, astropy and pint (lower case, without blanks), and its value in CGS.
struct KnownUnit {
  const char* name;
  std::vector<std::string> spellings;
  double in_cgs;
};

const KnownUnit& find_unit(const std::string& name) {
  static const std::array<KnownUnit, 7> units = {
      {{"m", {"m", "meter", "meters", "metre", "metres"}, 100.0},
       {"m/s", {"m/s", "ms^-1", "ms-1", "ms**-1", "m*s^-1", "m*s**-1", "meter/second", "metre/second"}, 100.0},
       {"kg", {"kg", "kilogram", "kilograms"}, 1000.0},
       {"s", {"s", "sec", "second", "seconds"}, 1.0},
       {"rad/s", {"rad/s", "rads^-1", "rads-1", "rad*s**-1", "1/s", "s^-1", "s-1", "radian/second"}, 1.0},
       {"1", {"1", "none", "dimensionless"}, 1.0},
       // A group of different quantities has no single factor to CGS.
       {"SI", {"si", "mks", "m", "kg", "s", "1", without_blanks(ring_box_units)}, no_number}}};
  const auto* const found =
      std::find_if(units.begin(), units.end(), [&](const KnownUnit& unit) { return name == unit.name; });
  assert(found != units.end());
  return *found;
}

// Meaning of an attribute: a unit as text, a factor to CGS, or a number that is `wanted` for SI.
enum class States { unit, factor_to_cgs, number };

struct Statement {
  std::string_view name; // its letters and digits in lower case
  States what;
  const char* unit = nullptr; // null: the unit of the object
  double wanted = 1.0;
};

// Attributes of GADGET and related codes, SWIFT, yt, openPMD and netCDF.
constexpr std::array<Statement, 37> statements = {
    {{"unit", States::unit},
     {"units", States::unit},
     {"lengthunit", States::unit, "m"},
     {"lengthunits", States::unit, "m"},
     {"unitlength", States::unit, "m"},
     {"massunit", States::unit, "kg"},
     {"massunits", States::unit, "kg"},
     {"unitmass", States::unit, "kg"},
     {"timeunit", States::unit, "s"},
     {"timeunits", States::unit, "s"},
     {"unittime", States::unit, "s"},
     {"velocityunit", States::unit, "m/s"},
     {"velocityunits", States::unit, "m/s"},
     {"unitvelocity", States::unit, "m/s"},
     {"tocgs", States::factor_to_cgs},
     {"fieldtocgs", States::factor_to_cgs},
     {"cgsconversionfactor", States::factor_to_cgs},
     {"conversionfactortocgsnotincludingcosmologicalcorrections", States::factor_to_cgs},
     {"conversionfactortophysicalcgsincludingcosmologicalcorrections", States::factor_to_cgs},
     {"unitlengthincm", States::number, nullptr, 100.0},
     {"unitlengthincgs", States::number, nullptr, 100.0},
     {"unitlengthincgsul", States::number, nullptr, 100.0},
     {"unitmassing", States::number, nullptr, 1000.0},
     {"unitmassincgs", States::number, nullptr, 1000.0},
     {"unitmassincgsum", States::number, nullptr, 1000.0},
     {"unitvelocityincmpers", States::number, nullptr, 100.0},
     {"unitvelocityincgs", States::number, nullptr, 100.0},
     {"unittimeins", States::number},
     {"unittimeincgs", States::number},
     {"unittimeincgsut", States::number},
     {"tosi", States::number},
     {"tomks", States::number},
     {"unitsi", States::number},
     {"siconversionfactor", States::number},
     {"hubbleparam", States::number},
     {"scalefactor", States::number},
     {"addoffset", States::number, nullptr, 0.0}}};

// Groups that state the units of the file, in lower case. Other groups may state internal units of a program.
constexpr std::array<std::string_view, 5> groups_with_units = {"header", "parameters", "units", "ringbox", "parttype1"};

std::string letters_and_digits(const std::string& text) {
  std::string plain;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return plain;
}

// The value of an attribute: one text, or numbers; neither if it is empty.
struct Value {
  std::optional<std::string> text;
  std::vector<double> numbers;

  std::string shown() const {
    if (text)
      return "'" + *text + "'";
    return fmt::format("{:g}", numbers.front());
  }
};

Value value_of(const hdf5::Handle& object, const std::string& name, const std::string& attribute) {
  const hdf5::Layout layout = hdf5::layout_of_attribute(object, attribute);
  if (layout.count() == 0)
    return {};
  if (layout.type == "text" && layout.count() == 1)
    return {hdf5::read_text_attribute(object, attribute), {}};
  if (layout.is_numeric())
    return {{}, hdf5::read_attribute_values<double>(object, attribute)};
  throw IoError(
      fmt::format("the attribute {} of {} is neither a text nor numbers; correct or remove it", attribute, name));
}

// Parses a number in a text: SWIFT writes its parameters as text.
std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' ? std::optional(number) : std::nullopt;
}

bool are_all(const Value& value, double wanted, bool zero_states_nothing) {
  std::vector<double> numbers = value.numbers;
  if (value.text) {
    const std::optional<double> number = number_in(*value.text);
    if (!number)
      return false;
    numbers.push_back(*number);
  }
  return std::all_of(numbers.begin(), numbers.end(), [&](double number) {
    return (zero_states_nothing && number == 0.0) || std::fabs(number - wanted) <= 1e-6 * std::fabs(wanted);
  });
}

bool is_in(const Value& value, const Statement& statement, const KnownUnit& unit) {
  if (value.text && value.text->empty())
    return true;
  if (statement.what == States::number)
    return are_all(value, statement.wanted, statement.name == "hubbleparam"); // 0 in runs without expansion
  if (statement.what == States::factor_to_cgs)
    return are_all(value, unit.in_cgs, true);
  if (!value.text)
    return are_all(value, 1.0, false);
  const std::vector<std::string>& known = unit.spellings;
  return std::find(known.begin(), known.end(), without_blanks(*value.text)) != known.end();
}

} // namespace

void require_stated_unit(const hdf5::Handle& object, const std::string& name, const std::string& unit_name) {
  for (const std::string& attribute : hdf5::attribute_names(object)) {
    const auto is_named = [key = letters_and_digits(attribute)](const Statement& known) { return known.name == key; };
    const auto* const statement = std::find_if(statements.begin(), statements.end(), is_named);
    if (statement == statements.end())
      continue;
    const Value value = value_of(object, name, attribute);
    if (!is_in(value, *statement, find_unit(statement->unit != nullptr ? statement->unit : unit_name)))
      throw IoError(
          fmt::format("{} is in another unit (its attribute {} is {}), and Keeler takes {}; convert the values, "
                      "and correct the attribute",
                      name, attribute, value.shown(), unit_name == "1" ? "numbers without one" : unit_name));
  }
}

void require_stated_units_of_groups(const hdf5::Handle& root, const std::string& root_name) {
  require_stated_unit(root, root_name, "SI");
  for (const std::string& name : hdf5::names_in(root))
    if (std::find(groups_with_units.begin(), groups_with_units.end(), letters_and_digits(name)) !=
        groups_with_units.end())
      require_stated_unit(hdf5::open_group(root, name), "/" + name, "SI");
}

void require_none_missing(const hdf5::Handle& dataset, const std::string& name, std::span<const double> values) {
  for (const std::string& attribute : hdf5::attribute_names(dataset)) {
    const std::string key = letters_and_digits(attribute);
    if (key != "fillvalue" && key != "missingvalue")
      continue;
    for (const double none : value_of(dataset, name, attribute).numbers)
      if (const auto count = std::count(values.begin(), values.end(), none); count > 0)
        throw IoError(fmt::format("{} has {} of the value {:g}, which its attribute {} defines as missing; remove "
                                  "such particles from all arrays, or fill in their values",
                                  name, count, none, attribute));
  }
}

void require_whole_ids(const hdf5::Handle& dataset, const std::string& name) {
  constexpr double max_exact = 9007199254740992.0; // 2⁵³
  const hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
  if (layout.type.starts_with("uint"))
    return;
  std::vector<double> ids(layout.count());
  hdf5::read_dataset(dataset, hdf5::native_type<double>(), ids.data());
  const auto is_whole = [&](double id) {
    return id >= 0.0 && id == std::floor(id) && (id < max_exact || layout.type.starts_with("int"));
  };
  if (const auto odd = std::find_if_not(ids.begin(), ids.end(), is_whole); odd != ids.end())
    throw IoError(fmt::format("{} has {:g} in row {}, and an id is a whole number from 0 on; write them as integers",
                              name, *odd, odd - ids.begin()));
}

} // namespace keeler::io
