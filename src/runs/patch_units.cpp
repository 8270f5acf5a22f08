#include <keeler/runs/patch_units.hpp>

#include <keeler/core/exact_sum.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <cassert>

namespace keeler::runs {

quantities::PatchUnits units_of(const Patch& patch) {
  assert(patch.size() > 0);
  return {diagnostics::mean_radius(patch), patch.orbital_frequency, newton_g_si * diagnostics::surface_density(patch)};
}

quantities::PatchUnits units_of(const Particles& particles, double area, double orbital_frequency,
                                const Communicator& ranks) {
  ExactSum radii, masses;
  for (const Body& body : particles.bodies) {
    radii += body.radius;
    masses += body.mass;
  }
  ranks.merge({&radii, &masses});
  const std::uint64_t count = ranks.sum(particles.size());
  assert(count > 0 && area > 0.0);
  return {radii.value() / static_cast<double>(count), orbital_frequency, newton_g_si * masses.value() / area};
}

} // namespace keeler::runs
