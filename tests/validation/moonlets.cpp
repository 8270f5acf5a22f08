// Moonlets: how their orbits wander, and what they do to the ring around them.
#include "rows.hpp"

#include <keeler/core/units.hpp>
#include <keeler/statistics/time_series.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::validation {
namespace {

constexpr double settled_moonlet = 2.0; // orbits

// ⟨(X(t + lag) − X(t))²⟩ of a moonlet's guiding centre.
double mean_square_step(const Ran& ran, double lag) {
  const std::vector<double>&orbits = ran.moonlets.of("time_orbits"), &x = ran.moonlets.of("guiding_x_m");
  const auto ahead = static_cast<std::size_t>(std::lround(lag / (orbits[1] - orbits[0])));
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k + ahead < x.size(); ++k)
    if (orbits[k] >= settled_moonlet) {
      sum += (x[k + ahead] - x[k]) * (x[k + ahead] - x[k]);
      count += 1.0;
    }
  return sum / count;
}

// The shear brings particles of mass m at a distance b from the moonlet's orbit, n (3/2) Ω b db a time and side. It
// pushes them aside to the sum of the radii, R: M ΔX = m (R − b) each. So ⟨ΔX²⟩ grows by n Ω (m/M)² R⁴/4 a time.
double by_impulses(double depth, double radius, double moonlet) {
  const double many = depth / (pi * radius * radius), mass = std::pow(radius / moonlet, 3.0), reach = radius + moonlet;
  return two_pi * many * mass * mass * std::pow(reach, 4.0) / 4.0; // an orbit
}

std::vector<Row> walk() {
  constexpr const char* paper = "Rein & Papaloizou 2010, A&A 524, A22";
  const Ran wakes = run_example("papers/rein-papaloizou-2010", {});
  const Ran collisions = run_example(
      "equilibrium", {"box.size=[200,300]", "moonlet=[{ radius = 25.0, density = 900.0 }]", "time.step=4e-3",
                      "time.end=60", "output.series_every=0.1", "output.snapshot_every=60"});
  const double wander = std::sqrt(100.0 * mean_square_step(wakes, 1.0)), orbits_seen = 8.0 - settled_moonlet;
  const double step = mean_square_step(collisions, 1.0);
  return {{.what = "wander of a moonlet of 25 m in 100 orbits, m, from its steps of one orbit",
           .measured = wander,
           .error = wander / std::sqrt(2.0 * orbits_seen),
           .expected = 55.0,
           .tolerance = 45.0,
           .tolerance_is = "the range published, of moonlets of 20 to 50 m",
           .source = fmt::format("10 to 100 m: {}", paper),
           .command = wakes.command},
          {.what = "mean square step of a moonlet that only collides, over the impulses of what the shear brings",
           .measured = step / by_impulses(0.5, 1.0, 25.0),
           .error = step / by_impulses(0.5, 1.0, 25.0) * std::sqrt(2.0 / (60.0 - settled_moonlet)),
           .expected = 1.25,
           .tolerance = 0.75,
           .tolerance_is = "a factor of two, as good as the paper's own estimates are",
           .source = fmt::format("n Omega (m/M)^2 R^4/4, an estimate in the way of {}", paper),
           .command = collisions.command},
          {.what = "its mean square step of four orbits over four times that of one",
           .measured = mean_square_step(collisions, 4.0) / (4.0 * step),
           .error = mean_square_step(collisions, 4.0) / (4.0 * step) * std::sqrt(2.0 * 4.0 / (60.0 - settled_moonlet)),
           .expected = 1.0,
           .tolerance = 0.8,
           .tolerance_is = "twice the scatter of 14 steps",
           .source = fmt::format("a random walk: {}", paper),
           .command = "of the same run"}};
}

// Where a propeller is looked for, in Hill radii of its moonlet: 5 to 20 downstream, 1.5 to 2.5 off on either side, in
// rectangles of one along the radius and 5 along the orbit. And the same rectangles 3.5 and more off.
class Surroundings {
public:
  Surroundings(const Patch& patch, double hill) : patch_(patch), hill_(hill) {
    const auto largest = std::max_element(patch.radii.begin(), patch.radii.end());
    if (*largest > 1.5 * patch.radii.front()) // else the control, a ring particle: places about the middle of the box
      moonlet_ = patch.positions[static_cast<std::size_t>(largest - patch.radii.begin())];
    mean_ = static_cast<double>(patch.size()) / (patch.box.size_x * patch.box.size_y);
  }

  std::vector<double> lobes() const {
    std::vector<double> all;
    for (double along = 7.5; along < 20.0; along += 5.0)
      for (const double side : {1.0, -1.0})
        all.push_back(density(2.0 * side, -along * side));
    return all;
  }

  std::vector<double> beside() const {
    std::vector<double> all;
    for (double off = 4.0; off < 0.5 * patch_.box.size_x / hill_ - 0.8; off += 1.0)
      for (double along = 2.5; along + 2.5 <= patch_.box.size_y / hill_; along += 5.0)
        for (const double side : {1.0, -1.0})
          all.push_back(density(off * side, along));
    return all;
  }

private:
  // Over the mean, in the rectangle about a place beside the moonlet.
  double density(double x, double y) const {
    const double length = patch_.box.size_y;
    double count = 0.0;
    for (const Vec3& position : patch_.positions) {
      const double dx = position.x() - moonlet_.x() - hill_ * x, dy = position.y() - moonlet_.y() - hill_ * y;
      if (std::fabs(dx) < 0.5 * hill_ && std::fabs(dy - length * std::round(dy / length)) < 2.5 * hill_)
        count += 1.0;
    }
    return count / (5.0 * hill_ * hill_ * mean_);
  }

  const Patch& patch_;
  double hill_;
  Vec3 moonlet_ = Vec3::Zero();
  double mean_ = 0.0;
};

struct Propeller {
  Estimate depth;   ///< of its lobes, over the scatter of the ring beside; mean of the snapshots
  Estimate density; ///< in its lobes, over the mean; of the snapshots
  std::string command;
};

Propeller propeller(std::vector<std::string> overrides, double hill) {
  overrides.emplace_back("time.end=3");
  const Ran ran = run_example("papers/michikoshi-kokubo-2011", overrides);
  std::vector<double> depths, densities;
  for (const Patch& patch : ran.snapshots)
    if (patch.time_orbits > settled_moonlet - 1e-9) {
      const Surroundings around(patch, hill);
      const std::vector<double> beside = around.beside();
      const double lobes = mean_of(around.lobes()).value, mean = mean_of(beside).value;
      double square = 0.0;
      for (const double density : beside)
        square += (density - mean) * (density - mean);
      depths.push_back((mean - lobes) / std::sqrt(square / static_cast<double>(beside.size())));
      densities.push_back(lobes);
    }
  return {statistics::block_mean(depths), statistics::block_mean(densities), ran.command};
}

// What one sees in a picture is a lobe deeper than the ring's own structure.
std::vector<Row> propellers() {
  constexpr const char* source = "only where lambda_cr is below r_H: Michikoshi & Kokubo 2011, ApJ 732, L23";
  const std::vector<std::string> wakes = {"particles.density=900", "box.size=[110,450]"};
  const auto with = [&](const char* moonlet) {
    std::vector<std::string> keys = wakes;
    keys.emplace_back(moonlet);
    return keys;
  };
  const Propeller large = propeller({}, 15.0),
                  small = propeller(with("moonlet=[{ radius = 5.0, density = 600.0 }]"), 7.38),
                  control = propeller(with("moonlet=[{ radius = 0.5, density = 900.0 }]"), 7.38);
  const double ratio = small.density.value / control.density.value,
               error = ratio * std::hypot(small.density.error / small.density.value,
                                          control.density.error / control.density.value);
  const auto seen = [&](const char* wavelength, const Propeller& found, double expected, double tolerance,
                        const char* tolerance_is) {
    return Row{
        .what = fmt::format("depth of a propeller over the scatter of the ring beside, lambda_cr {} r_H", wavelength),
        .measured = found.depth.value,
        .error = found.depth.error,
        .expected = expected,
        .tolerance = tolerance + 2.0 * found.depth.error,
        .tolerance_is = tolerance_is,
        .source = source,
        .command = found.command};
  };
  return {
      seen("0.51", large, 4.0, 2.0, "seen: 2 and more, and twice the error"),
      seen("3.1", small, 1.0, 1.0, "not seen: below 2, and twice the error"),
      {.what = "surface density in the lobes over that at the same places of a ring without the moonlet, means of 11 "
               "snapshots, lambda_cr 3.1 r_H",
       .measured = ratio,
       .error = error,
       .expected = 1.0,
       .tolerance = 0.1 + 2.0 * error,
       .tolerance_is = "that there are none, and twice the error",
       .source = source,
       .command = control.command + "; and the run before",
       .known_difference = "The criterion is of single pictures. In the mean a propeller fades with lambda_cr and does "
                           "not end at r_H."}};
}

} // namespace

std::vector<Subject> moonlet_subjects() {
  return {{"moonlet-walk", "The random walk of a moonlet", false, walk},
          {"propellers", "Propellers", false, propellers}};
}

} // namespace keeler::validation
