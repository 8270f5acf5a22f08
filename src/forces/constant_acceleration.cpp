#include "constant_acceleration.hpp"

#include <keeler/core/parallel.hpp>

namespace keeler::forces {
namespace {

class ConstantAcceleration : public Force {
public:
  explicit ConstantAcceleration(const Vec3& acceleration) : acceleration_(acceleration) {}

  void accelerate(const Boundary&, std::span<Vec3> accelerations) override {
    parallel_for(accelerations.size(), [&](std::size_t k) { accelerations[k] = acceleration_; });
  }

private:
  Vec3 acceleration_; // m rad⁻²
};

Key component(const char* name, const char* meaning) {
  return {.path = name,
          .type = KeyType::number,
          .fallback = "0.0",
          .unit = "m/s^2",
          .meaning = meaning,
          .range = {.low = -1e-5, .high = 1e-5}};
}

} // namespace

ForceEntry constant_acceleration_entry() {
  return {"constant_acceleration",
          {component("radial", "acceleration of every particle outward"),
           component("azimuthal",
                     "acceleration of every particle along the orbit, which grows by about 2 a / Omega in m/s"),
           component("vertical", "acceleration of every particle upward")},
          [](const Parameters& p, const ForceContext& context) -> std::unique_ptr<Force> {
            const double omega = context.orbital_frequency;
            return std::make_unique<ConstantAcceleration>(
                Vec3(p.number("radial"), p.number("azimuthal"), p.number("vertical")) / (omega * omega));
          }};
}

} // namespace keeler::forces
