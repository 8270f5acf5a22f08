#include <keeler/light/photometry.hpp>

#include "path.hpp"
#include "sums.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::light {
namespace {

constexpr double first_error_rays = 4.0 * round_rays; // before these an error is too uncertain to stop at

// The beginning of a ray: a random point of the face that the observer sees.
Vec3 start_of_ray(const SphereCell& cell, const Vec3& observer, RandomStream& random) {
  const ShearingBox& box = cell.box();
  const double x = (random.uniform() - 0.5) * box.size_x, y = (random.uniform() - 0.5) * box.size_y;
  return {x, y, observer.z() > 0.0 ? cell.top() : cell.bottom()};
}

// One sight, round by round.
class Measurement {
public:
  Measurement(const std::vector<Tracer>& tracers, const Sight& sight, const PhotometrySettings& settings)
      : tracers_(tracers), sight_(sight), settings_(settings), sums_(tracers.size()) {
    assert(std::sin(sight.observer.elevation) != 0.0 && std::sin(sight.sun.elevation) != 0.0);
  }

  void trace_round() {
    const Vec3 observer = sight_.observer.direction(), sun = sight_.sun.direction();
    std::vector<RaySums> sums = sums_;
    for (std::size_t k = 0; k < tracers_.size(); ++k) {
      const Tracer& tracer = tracers_[k];
      // the same streams in every sight, so that a sight has the same result alone and in a table
      const std::uint64_t first = (static_cast<std::uint64_t>(k) << 40) + rays_;
      sums[k] += ordered_total<RaySums>(round_rays, [&](RaySums& total, std::size_t ray) {
        RandomStream random(settings_.seed, RandomPurpose::light, first + ray);
        const Vec3 start = start_of_ray(tracer.cell(), observer, random);
        total.add(follow_path(tracer, *settings_.law, sun, start, -observer, random));
      });
    }
    sums_ = std::move(sums); // not before a whole round is done: an interrupted one leaves nothing
    rays_ += round_rays;
  }

  std::uint64_t rays() const { return rays_; }

  double relative_error() const {
    const Photometry now = result();
    return now.reflectance.value > 0.0 ? now.reflectance.error / now.reflectance.value
                                       : std::numeric_limits<double>::infinity();
  }

  bool done() const {
    if (!settings_.error)
      return rays_ >= settings_.rays;
    return rays_ >= settings_.max_rays ||
           (static_cast<double>(rays_ * tracers_.size()) >= first_error_rays && relative_error() <= *settings_.error);
  }

  double fraction() const {
    if (!settings_.error)
      return static_cast<double>(rays_) / static_cast<double>(settings_.rays);
    const double ratio = *settings_.error / relative_error();
    return rays_ == 0 ? 0.0
                      : std::max(ratio * ratio, static_cast<double>(rays_) / static_cast<double>(settings_.max_rays));
  }

  Photometry result() const {
    Photometry result;
    result.sight = sight_;
    result.rays = rays_;
    std::vector<double> singles;
    const auto count = static_cast<double>(sums_.size());
    const auto mean = [&](RayMoments RaySums::*part) {
      Estimate all;
      double squares = 0.0;
      for (const RaySums& one : sums_) {
        const Estimate estimate = (one.*part).estimate(one.rays);
        all.value += estimate.value / count;
        squares += estimate.error * estimate.error;
      }
      all.error = std::sqrt(squares) / count;
      return all;
    };
    result.reflectance = mean(&RaySums::all);
    result.single = mean(&RaySums::single);
    result.multiple = mean(&RaySums::multiple);
    result.transmission = mean(&RaySums::passed);
    for (const RaySums& one : sums_) {
      singles.push_back(one.all.estimate(one.rays).value);
      result.scatterings += one.hits / (one.rays * count);
    }
    result.scatter = statistics::measured(result.reflectance.value, singles).scatter;
    return result;
  }

private:
  const std::vector<Tracer>& tracers_;
  Sight sight_;
  const PhotometrySettings& settings_;
  std::vector<RaySums> sums_; // of each snapshot
  std::uint64_t rays_ = 0;
};

} // namespace

std::vector<Photometry> photometry(std::span<const Patch> patches, std::span<const Sight> sights,
                                   const PhotometrySettings& settings,
                                   const std::function<void(const Progress&)>& report) {
  assert(!patches.empty() && settings.law && settings.rays > 0);
  require_tracer();
  std::vector<Tracer> tracers;
  for (const Patch& patch : patches)
    tracers.emplace_back(patch);
  double seconds = 0.0;
  const Stopwatch watch(seconds);
  std::vector<Photometry> results;
  for (std::size_t k = 0; k < sights.size(); ++k) {
    Measurement measurement(tracers, sights[k], settings);
    bool stopped = false;
    while (!measurement.done() && !stopped) {
      try {
        measurement.trace_round();
      } catch (const Interrupted&) {
        stopped = true;
      }
      if (!report || stopped)
        continue;
      const double done =
          (static_cast<double>(k) + std::min(1.0, measurement.fraction())) / static_cast<double>(sights.size());
      const double elapsed = watch.elapsed();
      report({done, elapsed, elapsed * (1.0 / done - 1.0), fmt::format("sight {} of {}", k + 1, sights.size())});
    }
    if (measurement.rays() > 0)
      results.push_back(measurement.result());
    if (stopped)
      break;
  }
  return results;
}

} // namespace keeler::light
