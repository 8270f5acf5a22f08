#include <keeler/core/field_table.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/simulation/state.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::simulation {

SimulationState::SimulationState(const Scene& scene) : moonlets(scene.moonlets.size()) {
  const std::vector<double> gains(moonlets.size());
  if (scene.gravity)
    forces.push_back({"gravity", {}, 0.0, 0.0, gains});
  for (const scene::ForceSettings& force : scene.external_forces)
    forces.push_back({force.entry->table, {}, 0.0, 0.0, gains});
  particles.rough = scene.collisions.friction.has_value();
  carries = scene.gravity && scene.gravity->carries();
}

// Precondition: the caller writes nothing through the table.
FieldTable SimulationState::fields() const {
  return const_cast<SimulationState*>(this)->fields();
}

FieldTable SimulationState::fields() {
  FieldTable table;
  particles.list_fields(table);
  for (ForceState& force : forces) {
    table.particle_rows<double>(force.name + "_accelerations", force.accelerations, "m rad^-2",
                                "of the last kick of this force");
    table.scalar(force.name + "_work", force.work, "kg m^2 rad^-2", "energy gained from its kicks");
    table.scalar(force.name + "_azimuthal_gain", force.azimuthal_gain, "kg m^2 rad^-2",
                 "sum of m c_y^2 gained by its kicks");
    if (!moonlets.empty())
      table.rows<double>(force.name + "_moonlet_gains", force.moonlet_gains, "kg m rad^-1",
                         "momentum along the orbit that its kicks gave each moonlet");
  }
  if (!moonlets.empty())
    table.rows<double>("moonlets", moonlets, "m", "X at the start; shifts of X and Y by wraps since");
  table.scalar("box_size_x", box.size_x, "m", "L_x");
  table.scalar("box_size_y", box.size_y, "m", "L_y");
  table.scalar("box_shear", box.shear, "1", "shear rate in units of the orbital frequency");
  table.scalar("box_first_offset", box.first_offset, "m", "shear offset at time zero");
  table.scalar("step", step, "1", "ticks done");
  table.scalar("step_length", step_length, "rad", "length of the step to come");
  control.list_fields(table);
  collisions.list_fields(table);
  if (carries)
    resting.list_fields(table);
  table.scalar("energy_start", energy.epicyclic, "kg m^2 rad^-2", "epicyclic energy when the run began");
  table.scalar("azimuthal_start", energy.azimuthal, "kg m^2 rad^-2", "sum of m c_y^2 when the run began");
  if (particles.rough)
    table.scalar("spin_start", energy.spin, "kg m^2 rad^-2", "energy of the spins when the run began");
  return table;
}

std::string SimulationState::fault(const Scene& scene, const Communicator& ranks) const {
  const std::size_t count = particles.size(), of_all = ranks.sum(count);
  if (of_all == 0 || particles.ids.size() != count || (particles.rough && particles.spins.size() != count))
    return "it has no particles, or their arrays have different lengths";
  if (moonlets.size() != scene.moonlets.size() || moonlets.size() > of_all)
    return fmt::format("it has {} moonlets, but its scene has {}", moonlets.size(), scene.moonlets.size());
  for (const ForceState& force : forces)
    if ((!force.accelerations.empty() && force.accelerations.size() != count) ||
        force.moonlet_gains.size() != moonlets.size())
      return fmt::format("the length of the arrays of {} is not its number of particles", force.name);
  const bool whole = control.step >= 1 && control.step <= scene::TimeSettings::longest && control.kick >= 0 &&
                     control.kick <= scene::TimeSettings::longest && step >= 0 && control.steps >= 0 &&
                     control.fits(step);
  if (!whole)
    return fmt::format("a step of {} ticks cannot begin at tick {}", control.step, step);
  const double length = static_cast<double>(control.step) * scene.step_length();
  if (!(std::abs(step_length - length) <= 1e-9 * length))
    return fmt::format("its step is {:g} rad long, but its scene's is {:g}", step_length, length);
  constexpr double longest_side = 1e9; // m
  const auto side = [](double size) { return size > 0.0 && size < longest_side; };
  if (!side(box.size_x) || !side(box.size_y) || !(std::abs(box.shear) < 10.0) || !(box.first_offset >= 0.0) ||
      !(box.first_offset <= box.size_y))
    return fmt::format("its box of {:g} m x {:g} m is invalid", box.size_x, box.size_y);
  return {};
}

double SimulationState::kick_work() const {
  double work = 0.0;
  for (const ForceState& force : forces)
    work += force.work;
  return work;
}

// A free epicycle keeps ½κ²e² = ½c_x² + ½c_y² + (S/κ²) c_y² while d(c_y²)/dt = −κ² c_x c_y. So the time integral of the
// translational stress follows, without sampling error, from the changes of c_y² by collisions and kicks.
EnergyBalance SimulationState::balance(const diagnostics::ParticleMeans& means, const Frequencies& f) const {
  const double part = f.shear() / (f.kappa * f.kappa);
  double azimuthal_gain = collisions.azimuthal_gain, booked = epicyclic_gain(collisions, f);
  for (const ForceState& force : forces) {
    azimuthal_gain += force.azimuthal_gain;
    booked += force.work + part * force.azimuthal_gain;
  }
  booked += resting.work;
  EnergyBalance b;
  b.energy = means.epicyclic_energy - part * means.azimuthal + means.spin.energy;
  b.start = energy.epicyclic - part * energy.azimuthal + energy.spin;
  b.translational_flux = (azimuthal_gain - (means.azimuthal - energy.azimuthal)) / (f.kappa * f.kappa);
  b.collisional_flux = collisions.momentum_flux;
  b.kick_work = kick_work();
  b.resting_work = resting.work;
  b.lost = collisions.energy_lost;
  b.residual = means.epicyclic_energy - energy.epicyclic + (means.spin.energy - energy.spin) - booked;
  return b;
}

} // namespace keeler::simulation
