#include <keeler/runs/patch_units.hpp>

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <cassert>

namespace keeler::runs {

quantities::PatchUnits units_of(const Patch& patch) {
  assert(patch.size() > 0);
  return {diagnostics::mean_radius(patch), patch.orbital_frequency, newton_g_si * diagnostics::surface_density(patch)};
}

} // namespace keeler::runs
