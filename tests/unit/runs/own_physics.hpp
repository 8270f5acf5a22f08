// A force, a size law, a start, a column and a quantity as a calling program has them.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/forces/force.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/runs/own_numbers.hpp>

#include <cmath>

namespace keeler::test {

inline Key number(const char* name, const char* fallback, double high) {
  return {.path = name, .type = KeyType::number, .fallback = fallback, .range = {.low = 0, .high = high}};
}

// Gas on circular orbits: −γ c. All epicycles decay as e^(−γ t).
class GasDrag : public forces::Force {
public:
  GasDrag(double rate, std::int64_t every) : rate_(rate), every_(every) {}
  std::int64_t kick_every() const override { return every_; }

  void accelerate(const forces::Boundary& at, std::span<Vec3> accelerations) override {
    const Rotation rotation = at.rotation();
    for (std::size_t k = 0; k < accelerations.size(); ++k)
      accelerations[k] = -rate_ * peculiar_velocity(at.particles.bodies[k].elements, at.frequencies, rotation);
  }

private:
  double rate_; // rad⁻¹
  std::int64_t every_;
};

inline forces::ForceEntry gas_drag(const char* name) {
  return {name,
          {number("rate", "0.1", 10.0),
           {.path = "every", .type = KeyType::integer, .fallback = "1", .range = {.low = 1, .high = 100}}},
          [](const Parameters& p, const forces::ForceContext&) -> std::unique_ptr<forces::Force> {
            return std::make_unique<GasDrag>(p.number("rate") / two_pi, p.integer("every"));
          },
          [](const Parameters& p, double) {
            if (p.number("rate") > 8.0)
              throw UsageError("the gas is too dense");
          }};
}

inline particles::SizeLaw uniform_sizes(const Parameters& p) {
  const double a = p.number("lowest"), b = p.number("highest");
  particles::SizeLaw law{a, b, 0, {}, {}};
  law.mean_power = [a, b](int k) { return (std::pow(b, k + 1) - std::pow(a, k + 1)) / ((k + 1) * (b - a)); };
  law.radius = [a, b](double u, std::size_t) { return a + u * (b - a); };
  return law;
}

// Ten metres from guiding centre to guiding centre, six a row, all at the innermost point of their epicycles.
inline std::vector<State> lattice(const Parameters& p, const particles::StartRequest& request) {
  std::vector<State> states;
  const double e = p.number("eccentricity");
  const auto missing = static_cast<std::size_t>(p.number("missing"));
  for (std::size_t k = 0; k + missing < request.radii.size(); ++k) {
    Elements el;
    el.guiding_x = (request.radii.size() > 1 ? -25.0 + p.number("shift") : 0.0) + 10.0 * static_cast<double>(k % 6);
    el.guiding_y = (request.radii.size() > 1 ? -20.0 : 0.0) + 10.0 * static_cast<double>(k / 6);
    el.e_cos = e;
    states.push_back(state_at(el, request.frequencies, Rotation(request.frequencies, 0.0)));
  }
  return states;
}

inline double mean_height(const Patch& patch) {
  double sum = 0.0;
  for (const Vec3& position : patch.positions)
    sum += std::fabs(position.z()) / static_cast<double>(patch.size());
  return sum;
}

inline double gas_work(const Simulation& simulation, const Scene& scene) {
  return simulation.state().forces.back().work * scene.planet.orbital_frequency * scene.planet.orbital_frequency;
}

inline bool has_gas(const Scene& scene) {
  return !scene.external_forces.empty() && scene.external_forces.front().parameters.number("rate") > 0.0;
}

inline void add_own_physics() {
  static const bool added = [] {
    add_force(gas_drag("gas_drag"));
    particles::add_size_law(
        {"uniform", {number("lowest", "0.5", 10.0), number("highest", "1.0", 10.0)}, uniform_sizes});
    particles::add_start(
        {"lattice",
         {number("eccentricity", "0.0", 100.0), number("shift", "0.0", 100.0), number("missing", "0.0", 9.0)},
         lattice});
    runs::add_series_column(
        {"gas_work_j", "J", "Energy since the start: work of the gas", "work of the gas", gas_work, has_gas});
    runs::add_quantity({"mean_height_m", "m", "mean height", "mean of |z|", mean_height});
    return true;
  }();
  (void)added;
}

} // namespace keeler::test
