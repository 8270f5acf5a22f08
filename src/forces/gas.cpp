// Gas moves with the shear, and slower along the orbit by the head wind w. A particle's velocity c beyond the shear
// decays to the gas's, u = (0, −w, 0), in its stopping time τ: dc/dt = (u − c)/τ. Over the interval h between kicks
// that equation has an exact solution, by which the two half kicks at a boundary change the c before both:
//
//   h a = (u − c) (1 − e^(−h/τ))
//
// So the step is of second order, and no h makes it unstable. Where h is long beside τ, however, kick and drift by
// turns have another steady state than both together. A u that differs by O(h²) gives exactly the terminal velocity,
// for any h: (docs/theory/gas-drag.md)
//
//   y = −w/(1 + κ²τ²), q = tan(κh/2) coth(h/2τ):   u = (2y(τ − q/κ), y(1 + κτq), 0)
#include "gas.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::forces {
namespace {

// A stopping time over an interval: what a velocity decays to, and at which rate in the mean.
struct Decay {
  Vec3 wind;
  double rate;

  Decay(double stopping_time, double head_wind, double kappa, double interval)
      : rate(-std::expm1(-interval / stopping_time) / interval) {
    const double turn = kappa * stopping_time, terminal = -head_wind / (1.0 + turn * turn);
    const double q = std::tan(0.5 * kappa * interval) / std::tanh(0.5 * interval / stopping_time);
    wind = terminal * Vec3(2.0 * (stopping_time - q / kappa), 1.0 + turn * q, 0.0);
  }

  Vec3 acceleration(const Vec3& velocity) const { return rate * (wind - velocity); }
};

class Gas : public Force {
public:
  Gas(double stopping_time, double radius, double head_wind)
      : stopping_time_(stopping_time), radius_(radius), head_wind_(head_wind) {}

  void accelerate(const Boundary& at, std::span<Vec3> accelerations) override {
    assert(accelerations.size() == at.particles.size() && at.interval > 0.0);
    const Rotation rotation = at.rotation();
    const Decay common(stopping_time_, head_wind_, at.frequencies.kappa, at.interval);
    parallel_for(accelerations.size(), [&](std::size_t k) {
      at.particles.prefetch_after(k);
      const Body& body = at.particles.bodies[k];
      const Vec3 c = peculiar_velocity(body.elements, at.frequencies, rotation);
      accelerations[k] =
          radius_ > 0.0 ? Decay(stopping_time_ * body.radius / radius_, head_wind_, at.frequencies.kappa, at.interval)
                              .acceleration(c)
                        : common.acceleration(c);
    });
  }

private:
  double stopping_time_; // rad
  double radius_;        // m; 0: all particles have this stopping time
  double head_wind_;     // m rad⁻¹
};

} // namespace

ForceEntry gas_entry() {
  return {
      "gas",
      {{.path = "stopping_time",
        .type = KeyType::number,
        .example = "0.16",
        .unit = "orbits",
        .meaning = "time in which drag slows the motion relative to the gas by a factor e; the Stokes number is 2 pi "
                   "times this",
        .range = {.low = 1e-9, .high = 1e9}},
       {.path = "head_wind",
        .type = KeyType::number,
        .fallback = "0.0",
        .unit = "m/s",
        .meaning = "by how much the gas is slower than a circular orbit (eta v_K); particles then drift inward",
        .range = {.low = -1e4, .high = 1e4}},
       {.path = "radius",
        .type = KeyType::number,
        .fallback = "0.0",
        .unit = "m",
        .meaning = "particles of this radius have this stopping time, others one in proportion to their radius "
                   "(Epstein's law, one material); 0: all have it",
        .range = {.low = 0, .high = 1e9}}},
      [](const Parameters& p, const ForceContext& context) -> std::unique_ptr<Force> {
        return std::make_unique<Gas>(two_pi * p.number("stopping_time"), p.number("radius"),
                                     p.number("head_wind") / context.orbital_frequency);
      }};
}

} // namespace keeler::forces
