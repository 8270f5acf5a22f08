#include <keeler/runs/series_columns.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/collision/finders.hpp>

#include <algorithm>
#include <iterator>

namespace keeler {
namespace {

using Sample = const SeriesSample&;

double speed(Sample s, double internal) { // from m rad⁻¹ to m s⁻¹
  return internal * s.scene.planet.orbital_frequency;
}

double joule(Sample s, double internal) { // from kg m² rad⁻² to J
  return internal * s.scene.planet.orbital_frequency * s.scene.planet.orbital_frequency;
}

const SimulationState& state(Sample s) {
  return s.simulation.state();
}

// With a finder that never errs particles cannot overlap by more than the start did, and to search for it would cost
// more than all other columns.
bool may_overlap(const Scene& scene) {
  return !make_finder(scene.collisions.finder)->exact();
}

const SeriesColumn all_columns[] = {
    {"time_orbits", "orbits", "time since the run began", [](Sample s) { return s.simulation.orbits(); }},
    {"dispersion_x_m_s", "m/s", "radial velocity dispersion, weighted by mass",
     [](Sample s) { return speed(s, s.means.dispersion.x()); }},
    {"dispersion_y_m_s", "m/s", "velocity dispersion along the orbit, beyond the shear, weighted by mass",
     [](Sample s) { return speed(s, s.means.dispersion.y()); }},
    {"dispersion_z_m_s", "m/s", "vertical velocity dispersion, weighted by mass",
     [](Sample s) { return speed(s, s.means.dispersion.z()); }},
    {"scale_height_m", "m", "√⟨z²⟩, weighted by mass", [](Sample s) { return s.means.scale_height; }},
    {"collisions", "1", "collisions faster than v_cut since the run began; each counts once, for two particles",
     [](Sample s) { return static_cast<double>(state(s).collisions.fast); }},
    {"slow_contacts", "1", "contacts slower than v_cut since the run began",
     [](Sample s) { return static_cast<double>(state(s).collisions.slow); }},
    {"energy_lost_j", "J", "energy lost in collisions since the run began",
     [](Sample s) { return joule(s, state(s).collisions.energy_lost); }},
    {"kick_work_j", "J", "energy gained from the kicks of all forces since the run began",
     [](Sample s) { return joule(s, state(s).kick_work()); }},
    {"edge_work_j", "J", "energy gained from wraps and collisions across the sheared edges since the run began",
     [](Sample s) { return joule(s, state(s).energy.wrap_work + state(s).collisions.edge_work); }},
    {"energy_residual_j", "J", "what the energy Σ m [½v² − S x² + ½ν²z²] has changed beyond the three above: rounding",
     [](Sample s) { return joule(s, s.simulation.energy_residual(s.means.energy)); }},
    {"momentum_flux_kg_m2_s", "kg m²/s",
     "Σ (x_j − x_i) (p_y gained by j) over collisions since the run began; its rate over M S Ω is the collisional "
     "viscosity",
     [](Sample s) { return state(s).collisions.momentum_flux * s.scene.planet.orbital_frequency; }},
    {"largest_overlap", "r_i + r_j",
     "largest overlap of any pair; only with a finder other than `certified`, which lets none overlap",
     [](Sample s) { return largest_overlap(s.simulation.patch()).depth; }, may_overlap},
};

} // namespace

SeriesSample::SeriesSample(const Scene& of_scene, const Simulation& of_simulation)
    : scene(of_scene), simulation(of_simulation),
      means(particle_means(of_simulation.state().particles, of_scene.planet.frequencies,
                           -0.5 * of_simulation.state().step_length)) {}

std::span<const SeriesColumn> series_columns() {
  return all_columns;
}

std::vector<SeriesColumn> series_columns_of(const Scene& scene) {
  std::vector<SeriesColumn> present;
  std::copy_if(std::begin(all_columns), std::end(all_columns), std::back_inserter(present),
               [&](const SeriesColumn& column) { return !column.in || column.in(scene); });
  return present;
}

std::vector<std::string> names_of(std::span<const SeriesColumn> columns) {
  std::vector<std::string> names;
  for (const SeriesColumn& column : columns)
    names.emplace_back(column.name);
  return names;
}

std::vector<double> values_of(std::span<const SeriesColumn> columns, const SeriesSample& sample) {
  std::vector<double> values;
  for (const SeriesColumn& column : columns)
    values.push_back(column.value(sample));
  return values;
}

} // namespace keeler
