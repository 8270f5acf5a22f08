// Gas moves with the shear, and slower along the orbit by the head wind w. A particle's velocity c beyond the shear
// decays to the gas's, u = (0, −w, 0), in its stopping time τ: dc/dt = (u − c)/τ. Over the interval h between kicks
// that equation has an exact solution, by which the two half kicks at a boundary change c:
//
//   h a = (u − c) (1 − e^(−h/τ))
//
// with the c before both. So the kick is the exact flow of the drag, the step is of second order for any h/τ, and no h
// makes it unstable (docs/theory/gas-drag.md).
#include "gas.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::forces {
namespace {

class Gas : public Force {
public:
  Gas(double stopping_time, double radius, double head_wind)
      : stopping_time_(stopping_time), radius_(radius), wind_(0.0, -head_wind, 0.0) {}

  void accelerate(const Boundary& at, std::span<Vec3> accelerations) override {
    assert(accelerations.size() == at.particles.size() && at.interval > 0.0);
    const Rotation rotation = at.rotation();
    const double common = -std::expm1(-at.interval / stopping_time_) / at.interval;
    parallel_for(accelerations.size(), [&](std::size_t k) {
      at.particles.prefetch_after(k);
      const Body& body = at.particles.bodies[k];
      const double rate =
          radius_ > 0.0 ? -std::expm1(-at.interval * radius_ / (stopping_time_ * body.radius)) / at.interval : common;
      accelerations[k] = rate * (wind_ - peculiar_velocity(body.elements, at.frequencies, rotation));
    });
  }

private:
  double stopping_time_; // rad
  double radius_;        // m; 0: all particles have this stopping time
  Vec3 wind_;            // u, m rad⁻¹
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
