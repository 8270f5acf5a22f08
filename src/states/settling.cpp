#include <keeler/states/settling.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

double mean_amplitude(std::span<const WakeSample> samples) {
  double sum = 0.0;
  for (const WakeSample& sample : samples)
    sum += sample.amplitude;
  return sum / static_cast<double>(samples.size());
}

} // namespace

std::optional<Settling> compare_windows(std::span<const WakeSample> history, std::size_t window) {
  if (window == 0 || history.size() < 2 * window)
    return std::nullopt;
  const auto last = history.last(window), before = history.last(2 * window).first(window);
  Settling settling;
  settling.amplitude = mean_amplitude(last);
  settling.before = mean_amplitude(before);
  const auto of_mean = [&](double difference) {
    return settling.amplitude > 0.0 ? std::fabs(difference) / settling.amplitude : HUGE_VAL;
  };
  settling.change = of_mean(settling.amplitude - settling.before);
  settling.deviation = of_mean(last.back().amplitude - settling.amplitude);
  settling.standing = std::all_of(last.begin(), last.end(), [](const WakeSample& sample) { return sample.standing; });
  return settling;
}

} // namespace keeler
