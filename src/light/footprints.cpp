#include <keeler/light/footprints.hpp>

#include "tracer.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::light {
namespace {

// Unbiased estimates of T, T², T³ and T⁴ of a sample, from the number of its rays that pass.
struct Powers {
  double first, second, third, fourth;

  Powers(double passed, double rays) {
    first = passed / rays;
    second = first * (passed - 1.0) / (rays - 1.0);
    third = second * (passed - 2.0) / (rays - 2.0);
    fourth = third * (passed - 3.0) / (rays - 3.0);
  }
};

// The numbers of rays that pass, track by track.
std::vector<std::uint32_t> passed_rays(const Tracer& tracer, const Bearing& star, const FootprintTrack& track,
                                       std::uint64_t first_track) {
  const SphereCell& cell = tracer.cell();
  const Vec3 to_star = star.direction();
  const Vec3 along(std::cos(track.azimuth), std::sin(track.azimuth), 0.0), across(-along.y(), along.x(), 0.0);
  const double far_face = to_star.z() > 0.0 ? cell.bottom() : cell.top(); // rays go towards the star
  std::vector<std::uint32_t> passed(track.tracks * track.samples);
  parallel_for(
      track.tracks,
      [&](std::size_t k) {
        RandomStream random(track.seed, RandomPurpose::light, first_track + k);
        const double x = (random.uniform() - 0.5) * cell.box().size_x, y = (random.uniform() - 0.5) * cell.box().size_y;
        for (std::size_t sample = 0; sample < track.samples; ++sample)
          for (std::size_t ray = 0; ray < track.rays; ++ray) {
            const double way = (static_cast<double>(sample) + random.uniform()) * track.length;
            const Vec3 point = Vec3(x, y, 0.0) + way * along + (random.uniform() - 0.5) * track.width * across;
            const bool blocked = tracer.blocked(point + far_face / to_star.z() * to_star, to_star);
            passed[k * track.samples + sample] += blocked ? 0 : 1;
          }
      },
      1);
  return passed;
}

// The mean of values of single tracks, and its error from their scatter.
Estimate mean_of_tracks(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  const auto count = static_cast<double>(values.size());
  for (const double value : values)
    mean += value / count;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (count * (count - 1.0)))};
}

FootprintStatistics statistics_of(const std::vector<std::uint32_t>& passed, const Bearing& star,
                                  const FootprintTrack& track) {
  FootprintStatistics result;
  result.star = star;
  const auto rays = static_cast<double>(track.rays);
  const std::size_t tracks = passed.size() / track.samples, lags = track.samples / 2 + 1;
  const auto fraction = [&](std::size_t k) { return static_cast<double>(passed[k]) / rays; };
  const auto of_tracks = [&](const auto& value) { // the mean over a track of a function of its samples
    std::vector<double> means(tracks);
    for (std::size_t k = 0; k < tracks; ++k)
      for (std::size_t sample = 0; sample < track.samples; ++sample)
        means[k] += value(k * track.samples + sample) / static_cast<double>(track.samples);
    return mean_of_tracks(means);
  };
  result.transmission = of_tracks(fraction);
  const double m = result.transmission.value;
  result.variance = of_tracks([&](std::size_t k) {
    const Powers t(passed[k], rays);
    return t.second - 2.0 * m * t.first + m * m;
  });
  const Estimate third = of_tracks([&](std::size_t k) {
    const Powers t(passed[k], rays);
    return t.third - 3.0 * m * t.second + 3.0 * m * m * t.first - m * m * m;
  });
  const Estimate fourth = of_tracks([&](std::size_t k) {
    const Powers t(passed[k], rays);
    return t.fourth - 4.0 * m * t.third + 6.0 * m * m * t.second - 4.0 * m * m * m * t.first + m * m * m * m;
  });
  result.autocovariance.assign(lags, result.variance.value);
  for (std::size_t lag = 1; lag < lags; ++lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k < tracks; ++k)
      for (std::size_t sample = 0; sample + lag < track.samples; ++sample)
        sum += (fraction(k * track.samples + sample) - m) * (fraction(k * track.samples + sample + lag) - m);
    result.autocovariance[lag] = sum / static_cast<double>(tracks * (track.samples - lag));
  }
  const double variance = result.variance.value, sine = std::fabs(std::sin(star.elevation));
  if (variance > 0.0) {
    const double scale = std::pow(variance, -1.5);
    result.skewness = Estimate{third.value * scale, third.error * scale};
    result.kurtosis = fourth.value / (variance * variance) - 3.0;
  }
  if (m > 0.0)
    result.optical_depth = m < 1.0 ? -sine * std::log(m) : 0.0;
  // N shadows at random of the area π r²/sin B in a footprint of the area A: var T = T² (τ/sin B) (π r²/sin B)/A
  if (variance > 0.0 && result.optical_depth && *result.optical_depth > 0.0)
    result.effective_radius =
        std::sqrt(variance / (m * m) * track.length * track.width * sine * sine / (pi * *result.optical_depth));
  return result;
}

} // namespace

std::vector<FootprintStatistics> footprint_statistics(std::span<const Patch> patches, std::span<const Bearing> stars,
                                                      const FootprintTrack& track,
                                                      const std::function<void(const Progress&)>& report) {
  assert(!patches.empty() && track.tracks >= 2 && track.samples >= 2 && track.rays >= 4);
  assert(track.length > 0.0 && track.width > 0.0);
  require_tracer();
  std::vector<Tracer> tracers;
  for (const Patch& patch : patches)
    tracers.emplace_back(patch);
  PhaseProgress progress(report);
  progress.begin("lines of sight", static_cast<double>(stars.size() * tracers.size()));
  std::vector<FootprintStatistics> results;
  for (const Bearing& star : stars) {
    assert(std::sin(star.elevation) != 0.0);
    std::vector<std::uint32_t> passed;
    try {
      for (std::size_t k = 0; k < tracers.size(); ++k) {
        const std::vector<std::uint32_t> one =
            passed_rays(tracers[k], star, track, static_cast<std::uint64_t>(k) << 40);
        passed.insert(passed.end(), one.begin(), one.end());
        progress.add(1.0);
      }
    } catch (const Interrupted&) {
      break;
    }
    results.push_back(statistics_of(passed, star, track));
  }
  return results;
}

} // namespace keeler::light
