#include <keeler/diagnostics/radial_modes.hpp>

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/statistics/time_series.hpp>

#include <cassert>
#include <cmath>

namespace keeler::diagnostics {
namespace {

struct Sums {
  std::complex<double> mass, momentum_x, momentum_y;

  Sums& operator+=(const Sums& more) {
    mass += more.mass;
    momentum_x += more.momentum_x;
    momentum_y += more.momentum_y;
    return *this;
  }
};

// `radius(p)`: the radial coordinate of particle p.
template<class Radius> std::vector<RadialMode> modes_over(const Radius& radius, const Patch& patch, int count) {
  assert(count >= 0 && patch.box.size_x > 0.0);
  const Vec3 mean = mean_velocity(patch);
  const double mass = total_mass(patch);
  std::vector<RadialMode> modes;
  for (int n = 1; n <= count; ++n) {
    const double k = two_pi * n / patch.box.size_x;
    const Sums sums = ordered_total<Sums>(patch.size(), [&](Sums& total, std::size_t p) {
      const std::complex<double> wave = patch.masses[p] * std::polar(1.0, -k * radius(p));
      const Vec3 v = peculiar_velocity(patch, p) - mean;
      total.mass += wave;
      total.momentum_x += v.x() * wave;
      total.momentum_y += v.y() * wave;
    });
    modes.push_back({n, 2.0 / mass * sums.mass, 2.0 / mass * sums.momentum_x, 2.0 / mass * sums.momentum_y});
  }
  return modes;
}

} // namespace

double RadialMode::epicyclic_speed(double kappa) const {
  return std::sqrt(std::norm(velocity_x) + std::norm(2.0 / kappa * velocity_y));
}

// Derivation: with φ = κt ∓ kx, v_x = κ e sin φ and 2 v_y/κ = κ e cos φ are the real parts of ±i and 1 times κ e
// exp(∓iκt) exp(ikx).
std::complex<double> RadialMode::outward(double kappa) const {
  return velocity_y / kappa - std::complex(0.0, 0.5) * velocity_x;
}

std::complex<double> RadialMode::inward(double kappa) const {
  return velocity_y / kappa + std::complex(0.0, 0.5) * velocity_x;
}

std::vector<RadialMode> radial_modes(const Patch& patch, int count) {
  return modes_over([&](std::size_t p) { return patch.positions[p].x(); }, patch, count);
}

std::vector<RadialMode> guiding_modes(const Patch& patch, int count) {
  const auto guiding_x = [&](std::size_t p) {
    return elements_from({patch.positions[p], patch.velocities[p]}, patch.frequencies, Rotation()).guiding_x;
  };
  return modes_over(guiding_x, patch, count);
}

double radial_mode_noise(const Patch& patch) {
  const double squares = ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k] * patch.masses[k]; });
  return 2.0 * std::sqrt(squares) / total_mass(patch);
}

std::optional<Growth> growth(std::span<const double> times, std::span<const double> values) {
  assert(times.size() == values.size());
  const auto count = static_cast<double>(values.size());
  double mean_time = 0.0, mean_log = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(values[k] > 0.0))
      return std::nullopt;
    mean_time += times[k] / count;
    mean_log += std::log(values[k]) / count;
  }
  double tt = 0.0, tl = 0.0, ll = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double t = times[k] - mean_time, l = std::log(values[k]) - mean_log;
    tt += t * t;
    tl += t * l;
    ll += l * l;
  }
  if (values.size() < 2 || !(tt > 0.0))
    return std::nullopt;
  Growth result;
  result.rate = tl / tt;
  if (values.size() > 2) {
    std::vector<double> about_line;
    for (std::size_t k = 0; k < values.size(); ++k)
      about_line.push_back(std::log(values[k]) - mean_log - result.rate * (times[k] - mean_time));
    const double independent = statistics::statistical_inefficiency(about_line);
    result.error = std::sqrt(independent * std::max(0.0, ll - tl * tl / tt) / ((count - 2.0) * tt));
  }
  return result;
}

std::vector<RadialModeAnalysis> analyze_radial_modes(std::span<const Patch> patches, int count) {
  std::vector<RadialModeAnalysis> result(static_cast<std::size_t>(count));
  std::vector<std::vector<double>> speeds(result.size());
  std::vector<double> times; // rad
  const double weight = 1.0 / static_cast<double>(patches.size());
  for (const Patch& patch : patches) {
    times.push_back(two_pi * patch.time_orbits);
    const std::vector<RadialMode> modes = radial_modes(patch, count);
    for (std::size_t k = 0; k < modes.size(); ++k) {
      const double speed = modes[k].epicyclic_speed(patch.frequencies.kappa);
      speeds[k].push_back(speed);
      result[k].n = modes[k].n;
      result[k].wavelength = patch.box.size_x / modes[k].n;
      result[k].density_amplitude += weight * std::abs(modes[k].density);
      result[k].density_phase_degrees = std::arg(modes[k].density) * 180.0 / pi;
      result[k].speed += weight * speed * patch.orbital_frequency;
    }
  }
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k].growth = growth(times, speeds[k]);
  return result;
}

} // namespace keeler::diagnostics
