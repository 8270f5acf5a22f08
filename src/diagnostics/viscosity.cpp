#include <keeler/diagnostics/viscosity.hpp>

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

namespace keeler::diagnostics {

double translational_viscosity(const Patch& patch) {
  const Vec3 mean = mean_velocity(patch);
  const double flux = mass_mean(patch, [&](std::size_t k) {
    const Vec3 v = peculiar_velocity(patch, k) - mean;
    return v.x() * v.y();
  });
  return flux / patch.box.shear;
}

} // namespace keeler::diagnostics
