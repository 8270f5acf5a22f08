#include <keeler/simulation/state.hpp>

#include <keeler/core/threads.hpp>

namespace keeler {

SimulationState::SimulationState(const Scene& scene) {
  if (scene.gravity)
    forces.push_back({"gravity", {}, 0.0});
  for (const ForceSettings& force : scene.external_forces)
    forces.push_back({force.entry->table, {}, 0.0});
}

FieldTable SimulationState::fields() {
  FieldTable table;
  particles.list_fields(table);
  for (ForceState& force : forces) {
    table.rows<double>(force.name + "_accelerations", force.accelerations, "m rad^-2",
                       "of the last kick of this force");
    table.scalar(force.name + "_work", force.work, "kg m^2 rad^-2", "energy gained from its kicks");
  }
  table.scalar("box_size_x", box.size_x, "m", "L_x");
  table.scalar("box_size_y", box.size_y, "m", "L_y");
  table.scalar("box_shear", box.shear, "1", "shear rate in units of the orbital frequency");
  table.scalar("box_first_offset", box.first_offset, "m", "shear offset at time zero");
  table.scalar("step", step, "1", "steps done");
  table.scalar("step_length", step_length, "rad", "length of a step");
  collisions.list_fields(table);
  table.scalar("energy_start", energy.start, "kg m^2 rad^-2", "epicyclic energy when the run began");
  table.scalar("energy_wrap_work", energy.wrap_work, "kg m^2 rad^-2", "gained by wraps across sheared edges");
  return table;
}

double SimulationState::kick_work() const {
  double work = 0.0;
  for (const ForceState& force : forces)
    work += force.work;
  return work;
}

double total_energy(const Particles& particles, const Frequencies& frequencies) {
  return ordered_sum(particles.size(), [&](std::size_t k) {
    return particles.bodies[k].mass * energy(particles.bodies[k].elements, frequencies);
  });
}

} // namespace keeler
