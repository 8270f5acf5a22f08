#include <keeler/core/key.hpp>

#include <keeler/core/format.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keeler {

bool KeyRange::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string KeyRange::words() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string below = fmt::format("{} {}", high_open ? "below" : "at most", format_number(high));
  if (low == -infinity)
    return high == infinity ? "" : below;
  if (high == infinity)
    return low_open ? fmt::format("above {}", format_number(low)) : fmt::format("from {} up", format_number(low));
  return low_open ? fmt::format("above {} and {}", format_number(low), below)
                  : fmt::format("from {} to {}", format_number(low), format_number(high));
}

bool KeyCondition::allows(const std::string& value) const {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::string KeyCondition::words() const {
  return values.empty() ? "" : fmt::format(" = \"{}\"", fmt::join(values, "\" or \""));
}

} // namespace keeler
