#include <keeler/initial_conditions/clumped.hpp>

#include "settling.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/viscosity.hpp>
#include <keeler/initial_conditions/broken.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

namespace keeler::initial_conditions {
namespace {

void require_gravity(const Scene& scene) {
  if (!scene.gravity)
    throw UsageError("the scene has no [gravity] (wakes are due to self-gravity); add [gravity] to it");
  if (!scene.gravity->by_pairs())
    throw UsageError("the scene's gravity is axisymmetric (radial waves make no wakes); choose another gravity.solver");
}

void require_room_to_settle(const SettleCriterion& criterion) {
  if (criterion.max_orbits < criterion.min_orbits())
    throw UsageError(fmt::format("wakes cannot have settled within {:g} orbits (means of {} orbits are compared, after "
                                 "orbit {:g}); allow at least {:g}",
                                 criterion.max_orbits, criterion.min_window_orbits, criterion.first_orbit,
                                 criterion.min_orbits()));
}

void require_visible_wakes(const Patch& patch) {
  if (patch.size() == 0 || diagnostics::wake_power(patch, diagnostics::critical_wavelength(patch)).snapshots == 0)
    throw UsageError(fmt::format("wakes would not be visible in this patch ({} particles; lambda_cr, {:.3g} m, spans "
                                 "too few of them); use more particles, a higher optical depth or a larger box",
                                 patch.size(), patch.size() ? diagnostics::critical_wavelength(patch) : 0.0));
}

// Returns a whole number of kick intervals: within an interval the closing half kick is missing.
std::int64_t steps_between_samples(const Scene& scene, const SettleCriterion& criterion) {
  const std::int64_t kicks = scene.kick_interval();
  const double interval = static_cast<double>(kicks) * scene.time.step;
  return kicks * std::max(1L, std::lround(1.0 / (criterion.samples_per_orbit * interval)));
}

SettleSample sample_of(const Simulation& simulation) {
  const diagnostics::ParticleMeans means = simulation.means();
  const simulation::EnergyBalance balance = simulation.balance(means);
  const std::optional<gravity::GravityEnergy> gravity = simulation.gravity_energy();
  const Patch patch = simulation.patch();
  const double work = balance.lost + balance.energy + (gravity ? gravity->potential : 0.0);
  return {simulation.orbits(), diagnostics::loss_viscosity(work, means.mass, patch.box.shear, 1.0),
          diagnostics::wake_power(patch, diagnostics::critical_wavelength(patch))};
}

void advance(Simulation& simulation) {
  try {
    simulation.advance();
  } catch (const InvariantError& error) {
    throw BrokenState(error, simulation);
  }
}

std::string difference(const char* name, const WindowMeans& means, const MeanBounds& bounds) {
  return fmt::format("{} by {:.0f} % with errors of {:.0f} % (settled is {:.0f} %, with errors of {:g} %)", name,
                     100.0 * means.change(), 100.0 * means.error(), 100.0 * means.tolerance, 100.0 * bounds.error);
}

[[noreturn]] void fail_unsettled(const Clumping& c, const Patch& patch) {
  const Settling& s = c.settling;
  if (s.standing < c.criterion.min_standing)
    throw Error(ExitCode::run_time,
                fmt::format("no wakes in the patch after {:.3g} orbits (they exceed the noise in {:.0f} % of the "
                            "samples): it is too light or too hot to clump (Toomre's Q is {:.3g}); raise the "
                            "optical depth or the density of the particles",
                            c.orbits, 100.0 * s.standing, diagnostics::toomre_q(patch)));
  throw Error(
      ExitCode::run_time,
      fmt::format("the wakes did not settle in {:.3g} orbits (between the last {} orbits and the {} before, these "
                  "means differ: {}; {}; {}); use a larger box, whose means scatter less, allow more orbits, "
                  "or start from a snapshot of a run",
                  c.orbits, s.window_orbits, s.window_orbits,
                  difference("viscosity", s.viscosity, c.criterion.viscosity),
                  difference("lambda_perp", s.wavelength, c.criterion.wavelengths),
                  difference("lambda_x", s.radial_wavelength, c.criterion.wavelengths)));
}

} // namespace

ClumpedState clumped_state(const Scene& scene, const SettleCriterion& criterion,
                           const std::function<void(const ClumpingProgress&)>& progress) {
  require_gravity(scene);
  require_room_to_settle(criterion);
  double seconds = 0.0;
  const Stopwatch watch(seconds);
  const Patch start = initial_patch(scene);
  Simulation simulation(decided_by(scene, scale_of(start)), start);
  require_visible_wakes(simulation.patch());

  Clumping clumping;
  clumping.criterion = criterion;
  clumping.orbital_frequency = scene.planet.orbital_frequency;
  const std::int64_t every = steps_between_samples(scene, criterion);
  clumping.sample_every_orbits = static_cast<double>(every) * scene.time.step;
  const auto orbit = static_cast<std::size_t>(std::max(1L, std::lround(1.0 / clumping.sample_every_orbits)));
  std::vector<SettleSample> history;
  ClumpingProgress p;
  p.criterion = criterion;
  for (;;) {
    advance(simulation);
    p.orbits = clumping.orbits = simulation.orbits();
    const bool sample = simulation.state().step % every == 0;
    if (sample) {
      const SettleSample& last = history.emplace_back(sample_of(simulation));
      const diagnostics::WakeWaves waves = wake_waves(last.waves);
      clumping.history.push_back({last.orbits, last.work, waves.contrast, waves.wavelength, waves.radial_wavelength});
      p.contrast = waves.contrast;
      p.settling = compare_windows(history, orbit, criterion);
      p.settled = p.settling && settled(*p.settling, criterion);
      clumping.settling = p.settling.value_or(Settling{});
    }
    p.elapsed_s = watch.elapsed();
    if (progress)
      progress(p);
    if (p.settled)
      return {simulation.patch(), clumping};
    if (sample && p.settling && p.orbits >= criterion.max_orbits)
      fail_unsettled(clumping, simulation.patch());
  }
}

std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping) {
  const SettleCriterion& criterion = clumping.criterion;
  const Settling& settling = clumping.settling;
  const double omega = clumping.orbital_frequency;
  std::map<std::string, std::vector<double>> numbers = {
      {"orbits", {clumping.orbits}},
      {"window_orbits", {static_cast<double>(settling.window_orbits)}},
      {"standing", {settling.standing}},
      {"contrast", {settling.contrast}},
      {"deviation", {settling.deviation}},
      {"first_orbit", {criterion.first_orbit}},
      {"least_window_orbits", {static_cast<double>(criterion.min_window_orbits)}},
      {"most_orbits", {criterion.max_orbits}},
      {"standard_errors", {criterion.standard_errors}},
      {"least_standing", {criterion.min_standing}},
      {"largest_deviation", {criterion.largest_deviation}},
      {"sample_every_orbits", {clumping.sample_every_orbits}},
  };
  const auto add = [&](const std::string& name, const WindowMeans& means, const MeanBounds& bounds, double unit) {
    numbers[name] = {unit * means.last.value};
    numbers[name + "_before"] = {unit * means.before.value};
    numbers[name + "_error"] = {unit * means.last.error};
    numbers[name + "_error_before"] = {unit * means.before.error};
    numbers[name + "_change"] = {means.change()};
    numbers[name + "_tolerance"] = {means.tolerance};
    numbers[name + "_least_tolerance"] = {bounds.change};
    numbers[name + "_largest_error"] = {bounds.error};
  };
  add("loss_viscosity_m2_s", settling.viscosity, criterion.viscosity, omega);
  add("wake_wavelength_m", settling.wavelength, criterion.wavelengths, 1.0);
  add("wake_radial_wavelength_m", settling.radial_wavelength, criterion.wavelengths, 1.0);
  for (const ClumpingSample& sample : clumping.history) {
    numbers["history_orbits"].push_back(sample.orbits);
    numbers["history_work_m2"].push_back(sample.work);
    numbers["history_contrast"].push_back(sample.contrast);
    numbers["history_wake_wavelength_m"].push_back(sample.wavelength.value_or(NAN));
    numbers["history_wake_radial_wavelength_m"].push_back(sample.radial_wavelength.value_or(NAN));
  }
  return numbers;
}

} // namespace keeler::initial_conditions
