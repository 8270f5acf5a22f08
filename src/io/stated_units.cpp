#include "stated_units.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

namespace keeler {
namespace {

// Also as yt, astropy and pint write it, in lower case and without blanks; and what it is in CGS.
struct Unit {
  const char* name;
  std::vector<std::string> spellings;
  double in_cgs;
};

const Unit& find_unit(const std::string& name) {
  static const std::array<Unit, 4> units = {
      {{"m", {"m", "meter", "meters", "metre", "metres"}, 100.0},
       {"m/s", {"m/s", "ms^-1", "ms-1", "ms**-1", "m*s^-1", "m*s**-1", "meter/second", "metre/second"}, 100.0},
       {"kg", {"kg", "kilogram", "kilograms"}, 1000.0},
       {"rad/s", {"rad/s", "rads^-1", "rads-1", "rad*s**-1", "1/s", "s^-1", "s-1", "radian/second"}, 1.0}}};
  return *std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return name == unit.name; });
}

std::string plain(const std::string& text) {
  std::string letters;
  for (const char c : text)
    if (c != ' ')
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

} // namespace

void require_stated_unit(const hdf5::Handle& dataset, const std::string& name, const std::string& unit_name) {
  const Unit& unit = find_unit(unit_name);
  const auto refuse = [&](const char* attribute, const std::string& value) {
    throw IoError(fmt::format("{} is in another unit (its attribute {} is {}), and Keeler takes {}; convert it, and "
                              "correct the attribute",
                              name, attribute, value, unit.name));
  };
  for (const char* attribute : {"unit", "units"})
    if (hdf5::has_attribute(dataset, attribute)) {
      const std::string stated = hdf5::read_text_attribute(dataset, attribute);
      const std::vector<std::string>& known = unit.spellings;
      if (!stated.empty() && std::find(known.begin(), known.end(), plain(stated)) == known.end())
        refuse(attribute, "'" + stated + "'");
    }
  for (const char* attribute : {"to_cgs", "CGSConversionFactor"})
    if (hdf5::has_attribute(dataset, attribute)) {
      const auto factor = hdf5::read_attribute<double>(dataset, attribute);
      if (factor != 0.0 && !(std::fabs(factor - unit.in_cgs) <= 1e-6 * unit.in_cgs)) // 0: not stated
        refuse(attribute, fmt::format("{:g}", factor));
    }
}

} // namespace keeler
