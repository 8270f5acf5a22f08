#include <keeler/runs/series_columns.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/registry.hpp>
#include <keeler/core/units.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/runs/own_numbers.hpp>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <string_view>

namespace keeler::runs {
namespace {

using Sample = const SeriesSample&;

double speed(Sample s, double internal) { // from m rad⁻¹ to m s⁻¹
  return internal * s.scene.planet.orbital_frequency;
}

double joule(Sample s, double internal) { // from kg m² rad⁻² to J
  return internal * s.scene.planet.orbital_frequency * s.scene.planet.orbital_frequency;
}

double flux(Sample s, double internal) { // from kg m² rad⁻¹ to kg m² s⁻¹
  return internal * s.scene.planet.orbital_frequency;
}

const simulation::SimulationState& state(Sample s) {
  return s.simulation.state();
}

// An exact finder lets no overlap exceed the initial one, and the search for it would cost more than all other columns.
bool may_overlap(const Scene& scene) {
  return !finders::make_finder(scene.collisions.finder)->exact();
}

bool has_spins(const Scene& scene) {
  return scene.collisions.friction.has_value();
}

bool is_driven(const Scene& scene) {
  return !scene.external_forces.empty();
}

bool carries(const Scene& scene) {
  return scene.gravity && scene.gravity->carries();
}

std::optional<diagnostics::EpicyclicWaves>
waves_in(const Simulation& simulation, const diagnostics::ParticleMeans& means, const Frequencies& frequencies) {
  const simulation::SimulationState& now = simulation.state();
  return epicyclic_waves(now.particles, now.box.size_x, frequencies, -0.5 * now.step_length, means, simulation.ranks());
}

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

const SeriesColumn all_columns[] = {
    {"time_orbits", "orbits", "", ColumnKind::value, "time since the run began",
     [](Sample s) { return s.simulation.orbits(); }},
    {"dispersion_x_m_s", "m/s", "Velocity dispersion: radial", ColumnKind::value,
     "radial velocity dispersion, weighted by mass", [](Sample s) { return speed(s, s.means.dispersion.x()); }},
    {"dispersion_y_m_s", "m/s", "Velocity dispersion: along the orbit", ColumnKind::value,
     "velocity dispersion along the orbit, beyond the shear, weighted by mass",
     [](Sample s) { return speed(s, s.means.dispersion.y()); }},
    {"dispersion_z_m_s", "m/s", "Velocity dispersion: vertical", ColumnKind::value,
     "vertical velocity dispersion, weighted by mass", [](Sample s) { return speed(s, s.means.dispersion.z()); }},
    {"scale_height_m", "m", "Scale height: √⟨z²⟩", ColumnKind::value, "√⟨z²⟩, weighted by mass",
     [](Sample s) { return s.means.scale_height; }},
    {"collisions", "1", "Collisions: faster than v_cut", ColumnKind::count,
     "collisions faster than v_cut since the run began; each counts once, for two particles",
     [](Sample s) { return static_cast<double>(state(s).collisions.fast); }},
    {"slow_contacts", "1", "Collisions: slower", ColumnKind::count, "contacts slower than v_cut since the run began",
     [](Sample s) { return static_cast<double>(state(s).collisions.slow); }},
    {"energy_lost_j", "J", "Energy since the start: lost in collisions", ColumnKind::sum,
     "energy lost in collisions since the run began",
     [](Sample s) { return joule(s, state(s).collisions.energy_lost); }},
    {"kick_work_j", "J", "Energy since the start: work of kicks", ColumnKind::sum,
     "work of all forces' kicks on the motion beyond the shear since the run began",
     [](Sample s) { return joule(s, s.balance.kick_work); }},
    {"resting_work_j", "J", "Energy since the start: work of contacts at rest", ColumnKind::sum,
     "work of the impulses of contacts at rest on the motion along their lines of centres since the run began; only "
     "with `[gravity]` where contacts at rest carry its kicks (`gravity.resting_contacts`)",
     [](Sample s) { return joule(s, s.balance.resting_work); }, carries},
    {"random_energy_j", "J", "Energy of the random motion: random motion", ColumnKind::value,
     "Σ m (½c² + ½ν²z²), c the velocity beyond the shear, and the energy of spins",
     [](Sample s) { return joule(s, s.balance.energy); }},
    {"energy_residual_j", "J", "Energy residual (rounding): residual", ColumnKind::sum,
     "change of Σ m (½κ²e² + ½ν²i²), and of the energy of spins, beyond the accounted work of kicks and collisions: "
     "rounding",
     [](Sample s) { return joule(s, s.balance.residual); }},
    {"translational_flux_kg_m2_s", "kg m²/s", "Viscosity: translational", ColumnKind::flux,
     "∫ Σ m c_x c_y dt since the run began; its rate over M S is the translational viscosity",
     [](Sample s) { return flux(s, s.balance.translational_flux); }},
    {"collisional_flux_kg_m2_s", "kg m²/s", "Viscosity: collisional", ColumnKind::flux,
     "Σ (x_j − x_i) (p_y gained by j) over collisions since the run began; its rate over M S is the collisional "
     "viscosity",
     [](Sample s) { return flux(s, s.balance.collisional_flux); }},
    {"translational_viscosity_m2_s", "m²/s", "Translational viscosity at an instant: ⟨c_x c_y⟩/S", ColumnKind::value,
     "⟨c_x c_y⟩/S at this instant, without the mean motion",
     [](Sample s) {
       return s.means.random_stress / s.scene.planet.frequencies.shear() * s.scene.planet.orbital_frequency;
     }},
    {"drift_viscosity_m2_s", "m²/s", "Viscosity of the mean motion at an instant: c̄_x c̄_y/S", ColumnKind::value,
     "c̄_x c̄_y/S of the mean motion c̄ at this instant, as a head wind makes it: `keeler analyze` takes it from the "
     "translational viscosity; only with external forces",
     [](Sample s) {
       return s.means.motion.x() * s.means.motion.y() / s.scene.planet.frequencies.shear() *
              s.scene.planet.orbital_frequency;
     },
     is_driven},
    {"gravitational_viscosity_m2_s", "m²/s", "Viscosity: gravitational", ColumnKind::value,
     "gravity's shear stress dΦ/dγ over M S at this instant; nan where it was not measured; only with `[gravity]`, "
     "`output.stress_every` above 0, and not with `gravity.images = \"rings\"`",
     [](Sample s) {
       return s.gravity ? s.gravity->stress / (s.means.mass * s.scene.planet.frequencies.shear()) *
                              s.scene.planet.orbital_frequency
                        : not_measured;
     },
     measures_gravity},
    {"potential_energy_j", "J", "Potential energy of self-gravity, from an arbitrary zero: potential",
     ColumnKind::value,
     "Φ of the patch in its own gravity, images included, from an arbitrary zero; nan where it was not measured; only "
     "together with `gravitational_viscosity_m2_s`",
     [](Sample s) { return s.gravity ? joule(s, s.gravity->potential) : not_measured; }, measures_gravity},
    {"mean_spin_omega", "Ω", "Spins: mean", ColumnKind::value,
     "mean spin about the vertical, against the stars; only with `[collisions.friction]`",
     [](Sample s) { return s.means.spin.mean.z(); }, has_spins},
    {"spin_dispersion_omega", "Ω", "Spins: dispersion", ColumnKind::value,
     "√⟨(ω − ⟨ω⟩)²⟩ of the spins, weighted by mass; only with `[collisions.friction]`",
     [](Sample s) { return s.means.spin.dispersion; }, has_spins},
    {"spin_energy_ratio", "1", "Energy of the spins over that of the random motion: ratio", ColumnKind::value,
     "Σ ½ I (ω − ⟨ω⟩)² over ½ M (c_x² + c_y² + c_z²) of the dispersions: spins against the random motion; only with "
     "`[collisions.friction]`",
     [](Sample s) { return s.means.spin.random_energy / (0.5 * s.means.mass * s.means.dispersion.squaredNorm()); },
     has_spins},
    {"spin_energy_j", "J", "Energy of the spins: spins", ColumnKind::value,
     "Σ ½ I (ω − Ω)² of the spins: their part of `random_energy_j`; only with `[collisions.friction]`",
     [](Sample s) { return joule(s, s.means.spin.energy); }, has_spins},
    {"step_orbits", "orbits", "Automatic step: step", ColumnKind::value,
     "length of the next step; only with `time.step = \"auto\"`",
     [](Sample s) { return state(s).step_length / two_pi; }, [](const Scene& scene) { return scene.time.automatic; }},
    {"kick_interval_orbits", "orbits", "Automatic step: kick interval", ColumnKind::value,
     "kick interval from now on; only with `time.step = \"auto\"`",
     [](Sample s) { return static_cast<double>(state(s).control.kick) * s.scene.time.step; },
     [](const Scene& scene) { return scene.time.automatic; }},
    {"largest_overlap", "r_i + r_j", "Largest overlap of a pair: overlap", ColumnKind::value,
     "largest overlap of any pair; only with a finder other than `certified`, which prevents overlaps",
     [](Sample s) { return cells::largest_overlap(s.simulation.patch()).depth; }, may_overlap},
    {"epicyclic_wave_fraction", "1", "Fraction of the epicyclic energy in box-long waves: axisymmetric waves",
     ColumnKind::value,
     "fraction of ⟨½κ²e²⟩ about the mean motion in axisymmetric waves as long as the box (modes 1 to 4 over the "
     "guiding radius), minus the part expected of random positions; nan for too few particles",
     [](Sample s) { return s.waves ? s.waves->energy : not_measured; }},
    {"dispersion_without_waves_x_m_s", "m/s", "Velocity dispersion: radial, without box-long waves", ColumnKind::value,
     "radial velocity dispersion about the velocity field of these waves; nan for too few particles",
     [](Sample s) { return s.waves ? speed(s, s.waves->residual_dispersion(s.means.dispersion).x()) : not_measured; }},
};

Registry<SeriesColumn>& registered_columns() {
  static Registry<SeriesColumn> columns("column", &SeriesColumn::name,
                                        {std::begin(all_columns), std::end(all_columns)});
  return columns;
}

} // namespace

SeriesSample::SeriesSample(const Scene& of_scene, const Simulation& of_simulation,
                           std::optional<gravity::GravityEnergy> of_gravity)
    : scene(of_scene), simulation(of_simulation), means(of_simulation.means()), balance(of_simulation.balance(means)),
      waves(waves_in(of_simulation, means, of_scene.planet.frequencies)), gravity(of_gravity) {}

void add_series_column(const OwnColumn& own, IfTaken if_taken) {
  if (own.name && own.name == std::string_view("step")) // each row begins with it
    fail_taken("column", own.name);
  registered_columns().add({own.name, own.unit, own.plot, ColumnKind::value, own.meaning, nullptr, own.in, own.value},
                           if_taken);
  assert(own.value && "a column has a function");
}

const std::vector<SeriesColumn>& series_columns() {
  return registered_columns().entries();
}

std::vector<quantities::Quantity> series_quantities() {
  std::vector<quantities::Quantity> all;
  for (const SeriesColumn& column : series_columns())
    all.push_back({column.name, quantities::unit::unnamed(column.unit), column.name, column.meaning});
  return all;
}

std::vector<SeriesColumn> series_columns_of(const Scene& scene) {
  std::vector<SeriesColumn> present;
  std::ranges::copy_if(series_columns(), std::back_inserter(present),
                       [&](const SeriesColumn& column) { return !column.in || column.in(scene); });
  return present;
}

std::vector<std::string> names_of(std::span<const SeriesColumn> columns) {
  std::vector<std::string> names;
  for (const SeriesColumn& column : columns)
    names.emplace_back(column.name);
  return names;
}

bool measures_gravity(const Scene& scene) {
  return scene.gravity && scene.output.stress_every > 0 && has_energy_meter(*scene.gravity);
}

std::vector<double> values_of(std::span<const SeriesColumn> columns, const SeriesSample& sample) {
  std::vector<double> values;
  for (const SeriesColumn& column : columns)
    values.push_back(column.own ? column.own(sample.simulation, sample.scene) : column.value(sample));
  return values;
}

} // namespace keeler::runs
