// The paper's Figure 1: in a ring whose collisions prefer one side of the epicycle, straight paths within a step make
// particles drift, and Keeler's do not. The size expected is what straight lines would have led beside the
// orbits at each collision, −a t²/2 to leading order, summed over collisions that happened on exact paths.
#include "perturbed_ring/perturbed_ring.hpp"

#include <keeler/finders/finders.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cassert>
#include <cmath>

using namespace keeler;

namespace {

constexpr double orbits = 6.0;
constexpr Frequencies frequencies{1.0, 1.0};

study::PerturbedRing ring_of(double step_orbits, std::uint64_t seed = 1) {
  study::PerturbedRing ring;
  ring.step_orbits = step_orbits;
  ring.orbits = orbits;
  ring.samples = 1;
  ring.seed = seed;
  return ring;
}

// Mean and standard deviation over seeds.
struct Scatter {
  double mean = 0.0, deviation = 0.0;
};

Scatter scatter(const std::vector<double>& values) {
  Scatter s;
  for (const double v : values)
    s.mean += v / static_cast<double>(values.size());
  for (const double v : values)
    s.deviation += (v - s.mean) * (v - s.mean) / static_cast<double>(values.size() - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

// Predicts, from a run with exact collisions, the drift that straight paths would cause: at each collision it adds the
// displacement from the orbit of a straight line that began at the start of the step or at the particle's previous
// collision. A displacement δx changes X by 4 δx, and δz the height by δz.
class StraightForecast final : public collision::DriftObserver {
public:
  explicit StraightForecast(std::size_t particles) : particles_(static_cast<double>(particles)) {}

  // The mean drift, in radii.
  double guiding_x() const { return guiding_x_ / particles_; }
  double vertical() const { return vertical_ / particles_; }

  void begins(const finders::DriftStep& step) override {
    epoch_ += epoch_ > 0.0 ? step.end - step.begin : step.end;
    bodies_ = step.bodies;
    orbits_.resize(bodies_.size());
    since_.assign(bodies_.size(), step.begin);
    for (std::size_t k = 0; k < bodies_.size(); ++k)
      orbits_[k] = bodies_[k].elements;
  }

  void collided(const collision::CollisionRecord& record) override { time_ = record.time; }

  void changed(std::size_t k) override {
    assert(k < orbits_.size() && time_ >= since_[k]);
    const State first = state_at(orbits_[k], frequencies, Rotation(frequencies, since_[k]));
    const State now = state_at(orbits_[k], frequencies, Rotation(frequencies, time_));
    const Vec3 beside = first.position + (time_ - since_[k]) * first.velocity - now.position;
    guiding_x_ += 4.0 * beside.x();
    vertical_ += beside.z() * std::sin(epoch_ + time_);
    orbits_[k] = bodies_[k].elements;
    since_[k] = time_;
  }

private:
  std::span<const Body> bodies_;
  std::vector<Elements> orbits_;
  std::vector<double> since_;
  double time_ = 0.0;
  double particles_, guiding_x_ = 0.0, vertical_ = 0.0;
  double epoch_ = 0.0; // mid-step, rad since the start of the run
};

} // namespace

TEST_CASE("straight paths drift where streamlines bunch, by as much as exact collisions foretell") {
  constexpr int seeds = 5;
  std::vector<double> x, vertical, control_x, control_vertical, forecast_x, forecast_vertical;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const study::PerturbedRing ring = ring_of(1e-2, seed);
    const study::DriftRow straight = perturbed_ring_drift(ring, study::straight_path).back();
    const study::DriftRow control = perturbed_ring_drift(ring, study::control_path).back();
    StraightForecast exact(ring.count);
    perturbed_ring_drift(ring, "certified", &exact);
    x.push_back(straight.mean_guiding_x_r);
    vertical.push_back(straight.mean_vertical_r);
    control_x.push_back(control.mean_guiding_x_r);
    control_vertical.push_back(control.mean_vertical_r);
    forecast_x.push_back(exact.guiding_x());
    forecast_vertical.push_back(exact.vertical());
  }
  const Scatter drift = scatter(x), none = scatter(control_x), foretold = scatter(forecast_x);
  const Scatter rise = scatter(vertical), no_rise = scatter(control_vertical),
                foretold_rise = scatter(forecast_vertical);
  MESSAGE("X after " << orbits << " orbits: straight " << drift.mean << " +- " << drift.deviation << " r, unperturbed "
                     << none.mean << " +- " << none.deviation << ", foretold " << foretold.mean << " +- "
                     << foretold.deviation);
  MESSAGE("vertical: straight " << rise.mean << " +- " << rise.deviation << " r, unperturbed " << no_rise.mean << " +- "
                                << no_rise.deviation << ", foretold " << foretold_rise.mean << " +- "
                                << foretold_rise.deviation);
  CHECK(drift.mean > 10.0 * none.deviation);
  CHECK(rise.mean > 10.0 * no_rise.deviation);
  // three standard errors of the difference of the two means, and a hundredth, as the drift feeds on itself
  const auto error = [](const Scatter& a, const Scatter& b) {
    return 3.0 * std::hypot(a.deviation, b.deviation) / std::sqrt(seeds);
  };
  CHECK(std::fabs(drift.mean - foretold.mean) < error(drift, foretold) + 0.01 * foretold.mean);
  CHECK(std::fabs(rise.mean - foretold_rise.mean) < error(rise, foretold_rise) + 0.01 * foretold_rise.mean);
}

TEST_CASE("the drift grows as the square of the step, and turns with the pattern") {
  const double coarse = perturbed_ring_drift(ring_of(1e-2), study::straight_path).back().mean_guiding_x_r;
  const double fine = perturbed_ring_drift(ring_of(2.5e-3), study::straight_path).back().mean_guiding_x_r;
  MESSAGE("X at steps of 1e-2 and 2.5e-3 orbit: " << coarse << ", " << fine << " r");
  CHECK(std::log2(coarse / fine) / 2.0 == doctest::Approx(2.0).epsilon(0.1)); // runs scatter by 10 %
  study::PerturbedRing mirrored = ring_of(1e-2);
  mirrored.waves = -mirrored.waves;
  const double back = perturbed_ring_drift(mirrored, study::straight_path).back().mean_guiding_x_r;
  CHECK(back == doctest::Approx(-coarse).epsilon(0.3)); // three times that scatter
}

TEST_CASE("no finder lets the mean guiding centre or the mean inclination drift beyond rounding") {
  for (const finders::FinderEntry& finder : finders::finder_table()) {
    CAPTURE(finder.name);
    study::PerturbedRing ring = ring_of(1e-2);
    ring.count = 400;
    const study::DriftRow row = perturbed_ring_drift(ring, finder.name).back();
    CHECK(row.collisions_per_particle > 30.0);
    // each collision rounds X in half a box of 32 m, and each step the inclination, by at most 7e-15 m
    const double rounding = 7.1e-15 * (row.collisions_per_particle + orbits / 1e-2);
    CHECK(std::fabs(row.mean_guiding_x_r) < rounding);
    CHECK(std::fabs(row.mean_vertical_r) < rounding);
  }
}

TEST_CASE("rows come evenly in time, and the CSV has a line for each") {
  study::PerturbedRing ring = ring_of(1e-2);
  ring.count = 100;
  ring.orbits = 0.2;
  ring.samples = 2;
  const std::vector<study::DriftRow> rows = perturbed_ring_drift(ring, study::straight_path);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].orbits == doctest::Approx(0.1));
  CHECK(rows[1].orbits == doctest::Approx(0.2));
  const std::string csv = drift_csv(rows);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK(std::count(csv.begin(), csv.end(), ',') == 3 * 5);
}
