#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace keeler {

std::string figures(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
    return text;
  const double rounded = std::strtod(text.c_str(), nullptr);
  if (std::fabs(rounded) >= 1.0 && std::fabs(rounded) < 1e7)
    return fmt::format("{:.0f}", rounded);
  const int power = std::atoi(text.c_str() + exponent + 1);
  return text.replace(exponent + 1, std::string::npos, std::to_string(power)); // 1e9, not 1e+09
}

std::string counted(std::uint64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

} // namespace keeler
