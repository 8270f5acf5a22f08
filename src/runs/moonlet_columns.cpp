#include "moonlet_columns.hpp"

#include <algorithm>
#include <iterator>

namespace keeler::runs {
namespace {

using Sampled = const MoonletSample&;

const Frequencies& frequencies(Sampled s) {
  return s.scene.planet.frequencies;
}

double momentum(Sampled s, double internal) { // from kg m rad⁻¹ to kg m s⁻¹
  return internal * s.scene.planet.orbital_frequency;
}

double guiding_x(Sampled s) {
  return s.body().elements.guiding_x - s.track().shift_x;
}

// The elements refer to half a step ahead, so the drift of Y in that time is undone, with the unwrapped X.
double guiding_y(Sampled s) {
  const double ahead = s.simulation.boundary().to_epoch;
  return s.body().elements.guiding_y - s.track().shift_y + frequencies(s).shear() * guiding_x(s) * ahead;
}

// Returns the momentum gained by gravity, or by all external forces.
double gains(Sampled s, bool of_gravity) {
  double sum = 0.0;
  for (const simulation::ForceState& force : s.simulation.state().forces)
    if ((force.name == "gravity") == of_gravity)
      sum += force.moonlet_gains[s.k];
  return sum;
}

// X changes by 2 Δv_y/κ² in kicks and collisions only: the collisional part is the total minus the kicks.
double collisional_gain(Sampled s) {
  const double kappa = frequencies(s).kappa;
  return 0.5 * kappa * kappa * s.body().mass * (guiding_x(s) - s.track().start_x) - gains(s, true) - gains(s, false);
}

const MoonletColumn all_moonlet_columns[] = {
    {"time_orbits", "orbits", "time since the run began", [](Sampled s) { return s.simulation.orbits(); }},
    {"id", "1", "id of the moonlet: the ids after the particles', in the order of the scene",
     [](Sampled s) { return static_cast<double>(s.simulation.first_moonlet() + s.k); }},
    {"guiding_x_m", "m", "X of its guiding centre, not wrapped: X − X at the start is a change of semi-major axis",
     guiding_x},
    {"guiding_y_m", "m", "Y of its guiding centre, not wrapped: its longitude beside that of the middle of the box",
     guiding_y},
    {"eccentricity_m", "m", "radius e of its epicycle", [](Sampled s) { return s.body().elements.eccentricity(); }},
    {"inclination_m", "m", "amplitude i of its vertical motion",
     [](Sampled s) { return s.body().elements.inclination(); }},
    {"collision_momentum_kg_m_s", "kg m/s",
     "momentum along the orbit that collisions gave it since the run began; times the distance from the planet it is "
     "the angular momentum",
     [](Sampled s) { return momentum(s, collisional_gain(s)); }},
    {"gravity_momentum_kg_m_s", "kg m/s",
     "momentum along the orbit by the gravity of the particles; only with `[gravity]`",
     [](Sampled s) { return momentum(s, gains(s, true)); },
     [](const Scene& scene) { return scene.gravity.has_value(); }},
    {"force_momentum_kg_m_s", "kg m/s", "momentum along the orbit by external forces; only with such forces",
     [](Sampled s) { return momentum(s, gains(s, false)); },
     [](const Scene& scene) { return !scene.external_forces.empty(); }},
};

} // namespace

std::span<const MoonletColumn> moonlet_columns() {
  return all_moonlet_columns;
}

std::vector<MoonletColumn> moonlet_columns_of(const Scene& scene) {
  std::vector<MoonletColumn> present;
  if (!scene.moonlets.empty())
    std::copy_if(std::begin(all_moonlet_columns), std::end(all_moonlet_columns), std::back_inserter(present),
                 [&](const MoonletColumn& column) { return !column.in || column.in(scene); });
  return present;
}

} // namespace keeler::runs
