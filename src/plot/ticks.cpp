#include <keeler/plot/ticks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::plot {
namespace {

// Numbers outside 10^least to 10^most are written with a power of ten.
constexpr int least_plain = -3, most_plain = 4;

int exponent_of(double value) {
  return static_cast<int>(std::floor(std::log10(value) + 1e-9));
}

std::vector<Tick> linear_ticks(const AxisRange& range, double most) {
  const double step = round_above((range.high - range.low) / most);
  const int largest = exponent_of(std::max(std::fabs(range.low), std::fabs(range.high)));
  const int power = largest < least_plain || largest > most_plain ? largest : 0;
  const int decimals = std::max(0, power - exponent_of(step));
  std::vector<Tick> ticks;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * step; ++k) {
    const double value = k * step + 0.0; // no "-0"
    std::string label = fmt::format("{:.{}f}", value / std::pow(10.0, power), decimals);
    if (power != 0 && k != 0.0)
      label += fmt::format("·10^{{{}}}", power);
    ticks.push_back({value, k == 0.0 ? "0" : label});
  }
  return ticks;
}

std::vector<Tick> log_ticks(const AxisRange& range, double most) {
  const double decades = std::log10(range.high / range.low);
  const int first = exponent_of(range.low), last = exponent_of(range.high);
  const bool plain = first >= least_plain && last <= most_plain, few = decades < 2.0;
  const int every = std::max(1, static_cast<int>(std::ceil(decades / most)));
  std::vector<Tick> ticks;
  for (int power = first; power <= last; ++power)
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < range.low * (1.0 - 1e-9) || value > range.high * (1.0 + 1e-9))
        continue;
      const bool labelled = few ? digit == 1 || digit == 2 || digit == 5 : digit == 1 && power % every == 0;
      if (!labelled)
        ticks.push_back({value, ""});
      else if (plain)
        ticks.push_back({value, fmt::format("{:g}", value)});
      else
        ticks.push_back({value, fmt::format("{}10^{{{}}}", digit == 1 ? "" : fmt::format("{}·", digit), power)});
    }
  return ticks;
}

} // namespace

double round_below(double value) {
  assert(value > 0.0);
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0})
    if (step * power <= value)
      return step * power;
  return power;
}

double round_above(double value) {
  const double below = round_below(value), power = std::pow(10.0, std::floor(std::log10(value)));
  return below >= value ? below : below < 1.5 * power ? 2.0 * power : below < 3.0 * power ? 5.0 * power : 10.0 * power;
}

void AxisRange::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

AxisRange AxisRange::with_margin(bool log) const {
  assert(!empty() && (!log || low > 0.0));
  constexpr double margin = 0.06;
  if (log) {
    const double factor = std::max(std::pow(high / low, margin), 1.1);
    return {low / factor, high * factor};
  }
  const double span = high - low, size = std::max(std::fabs(low), std::fabs(high));
  const double wider = span > 1e-9 * size ? margin * span : std::max(0.1 * size, 1e-12);
  return {low >= 0.0 && low < 0.5 * high ? 0.0 : low - wider, high + wider};
}

std::vector<Tick> ticks_of(const AxisRange& range, bool log, double most) {
  assert(range.low < range.high && (!log || range.low > 0.0) && most > 0.0);
  const std::vector<Tick> ticks = log ? log_ticks(range, most) : linear_ticks(range, most);
  const bool readable = std::count_if(ticks.begin(), ticks.end(), [](const Tick& t) { return !t.label.empty(); }) >= 2;
  return readable || !log ? ticks : linear_ticks(range, most); // a short piece of a decade
}

} // namespace keeler::plot
