// Python bindings of a simulation: views of its state, its steps, and changes of the state.
#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "held_simulation.hpp"
#include "snapshot.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/initial_conditions/broken.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <bit>
#include <cassert>

namespace keeler::python {
namespace {

using Held = HeldSimulation;

// Makes a simulation of start(), with the settings that depend on the initial state filled in.
template<class Make> std::unique_ptr<Held> from_patch(const Scene& scene, const Make& start) {
  Scene decided;
  auto simulation = make_interruptibly([&] {
    const Patch patch = start();
    decided = decided_by(scene, initial_conditions::scale_of(patch));
    return std::make_unique<Simulation>(decided, patch);
  });
  return std::make_unique<Held>(decided, std::move(simulation));
}

std::unique_ptr<Held> from_scene(const Scene& scene) {
  return from_patch(scene, [&] {
    if (!scene.start_from)
      advice::require_memory_for(scene, scene.particles.count);
    return initial_patch(scene);
  });
}

std::unique_ptr<Held> from_snapshot(const PythonSnapshot& snapshot, const std::string& name, const Scene& scene) {
  return from_patch(scene, [&] { return initial_conditions::patch_from_snapshot(snapshot.patch, name, scene); });
}

std::unique_ptr<Held> from_stored(runs::StoredRun stored) {
  auto simulation =
      make_interruptibly([&] { return std::make_unique<Simulation>(stored.scene, std::move(stored.state)); });
  return std::make_unique<Held>(stored.scene, std::move(simulation));
}

// Loads the newest checkpoint; calls `notice` with each note.
std::unique_ptr<Held> resume(const std::filesystem::path& folder, const py::function& notice) {
  return from_stored(
      runs::load_newest_checkpoint(folder, [&](const std::string& line) { notice(printable_line(line)); }));
}

// --- strided views of the bodies in memory

py::capsule owner_of(const Held& held) {
  return {new std::shared_ptr<ViewedState>(held.viewed_state()),
          [](void* owner) { delete static_cast<std::shared_ptr<ViewedState>*>(owner); }};
}

py::array elements(const Held& held) {
  const std::vector<Body>& bodies = held.state().particles.bodies;
  static_assert(sizeof(Elements) == 6 * sizeof(double));
  return view(&bodies.data()->elements.guiding_x, {static_cast<py::ssize_t>(bodies.size()), 6},
              {sizeof(Body), sizeof(double)}, owner_of(held));
}

template<double Body::*Field> py::array of_bodies(const Held& held) {
  const std::vector<Body>& bodies = held.state().particles.bodies;
  return view(&(bodies.data()->*Field), {static_cast<py::ssize_t>(bodies.size())}, {sizeof(Body)}, owner_of(held));
}

py::array ids(const Held& held) {
  return view(held.state().particles.ids, owner_of(held));
}

// --- Cartesian copies in memory order

// Returns positions (m) and velocities (m/s).
std::pair<py::array, py::array> motion(const Held& held) {
  const simulation::SimulationState& state = held.state();
  const std::size_t count = state.particles.size();
  py::array_t<double> positions({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  py::array_t<double> velocities({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  double *const x = positions.mutable_data(), *const v = velocities.mutable_data();
  const Frequencies& frequencies = held.scene().planet.frequencies;
  const Rotation rotation(frequencies, held.simulation().time_at_break());
  const double omega = held.scene().planet.orbital_frequency;
  require_own_threads();
  parallel_for(count, [&](std::size_t k) {
    const State at = state_at(state.particles.bodies[k].elements, frequencies, rotation);
    Eigen::Map<Vec3>(x + 3 * k) = at.position;
    Eigen::Map<Vec3>(v + 3 * k) = omega * at.velocity;
  });
  return {sealed(std::move(positions)), sealed(std::move(velocities))};
}

// Returns inertial spins in components of Hill's frame at the current time, rad/s; None for smooth particles.
py::object spins(const Held& held) {
  const simulation::SimulationState& state = held.state();
  if (!state.particles.rough)
    return py::none();
  const particles::SpinTurn turn(held.simulation().time_at_break());
  assert(state.particles.spins.size() == state.particles.size());
  std::vector<Vec3> now(state.particles.size());
  for (std::size_t k = 0; k < now.size(); ++k)
    now[k] = turn.from_epoch(state.particles.spins[k]);
  return scaled_copy(now, held.scene().planet.orbital_frequency);
}

double orbits(const Held& held) {
  const Simulation& simulation = held.simulation();
  return simulation.orbits() + (simulation.time_at_break() + 0.5 * simulation.state().step_length) / two_pi;
}

// Returns the state as a snapshot; of a broken state only the particles that a file may hold.
PythonSnapshot snapshot(const Held& held) {
  require_own_threads();
  Patch patch = held.simulation().patch_at_break();
  if (held.broken() && initial_conditions::keep_possible(patch) > 0 && patch.size() == 0)
    throw Error(ExitCode::run_time, "no particle of this broken simulation is valid in a snapshot; use its arrays");
  return {std::move(patch), held.scene().resolved};
}

// --- changes

bool same_bits(const double* a, const double* b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return bits(a[0]) == bits(b[0]) && bits(a[1]) == bits(b[1]) && bits(a[2]) == bits(b[2]);
}

void change_spins(Particles& particles, const Doubles& spins, const py::object& before, double after, double omega) {
  if (before.is_none())
    throw UsageError("spins are given, but the particles of this scene are smooth; leave spins None, or add "
                     "[collisions.friction] to the scene");
  const auto old = before.cast<Doubles>();
  const particles::SpinTurn turn(after);
  const std::vector<Vec3> rows = vectors_from(spins, particles.size(), "spins", 1.0 / omega);
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!same_bits(spins.data() + 3 * k, old.data() + 3 * k))
      particles.spins[k] = turn.to_epoch(rows[k]);
}

// Throws InvariantError if the changed particles would not be valid in an initial state.
void require_possible_change(const Held& held, const Particles& particles) {
  const simulation::SimulationState& state = held.state();
  Patch patch = make_patch(particles, state.box, held.simulation().boundary().offset, held.scene().planet.frequencies,
                           -0.5 * state.step_length);
  patch.orbital_frequency = held.scene().planet.orbital_frequency;
  initial_conditions::require_possible_particles(patch, "the changed state");
}

// Replaces the particles by arrays in memory order. Only particles with a changed position or velocity get new
// elements: the conversion to Cartesian form and back loses a bit or two.
void replace(Held& held, const Doubles& positions, const Doubles& velocities, const Doubles& radii,
             const Doubles& masses, const std::optional<Doubles>& changed_spins) {
  const simulation::SimulationState& state = held.whole_state();
  const std::size_t count = state.particles.size();
  const Frequencies& frequencies = held.scene().planet.frequencies;
  const double omega = held.scene().planet.orbital_frequency;
  const auto [old_positions, old_velocities] = motion(held);
  const Doubles before_x = old_positions, before_v = old_velocities;
  vectors_from(positions, count, "positions"), vectors_from(velocities, count, "velocities"); // check the shapes
  const std::vector<double> new_radii = numbers_from(radii, count, "radii"),
                            new_masses = numbers_from(masses, count, "masses");
  Particles particles = state.particles;
  const Rotation rotation = held.simulation().boundary().rotation();
  for (std::size_t k = 0; k < count; ++k) {
    const double *const x = positions.data() + 3 * k, *const v = velocities.data() + 3 * k;
    Body& body = particles.bodies[k];
    body.radius = new_radii[k], body.mass = new_masses[k];
    const bool moved = !same_bits(x, before_x.data() + 3 * k);
    if (!moved && same_bits(v, before_v.data() + 3 * k))
      continue;
    const State at{Vec3(x[0], x[1], x[2]), Vec3(v[0], v[1], v[2]) / omega};
    if (const std::string fault = moved ? initial_conditions::box_fault(at, state.box, frequencies) : "";
        !fault.empty())
      throw InvariantError(
          fmt::format("particle {} of the changed state has {}; correct it", state.particles.ids[k], fault));
    body.elements = elements_from(at, frequencies, rotation);
  }
  if (changed_spins)
    change_spins(particles, *changed_spins, spins(held), -0.5 * state.step_length, omega);
  require_possible_change(held, particles);
  held.replace(std::move(particles));
}

py::array contacts(Held& held) {
  return held.take_contacts([](const std::vector<ContactRecord>& rows) -> py::array {
    return py::array_t<ContactRecord>(static_cast<py::ssize_t>(rows.size()), rows.data());
  });
}

void save(const Held& held, const std::filesystem::path& file) {
  runs::store_checkpoint(file, held.whole_state(), held.scene());
}

// Returns the work of each force since the run began, J.
py::dict works(const Held& held) {
  const double omega = held.scene().planet.orbital_frequency;
  py::dict all;
  for (const simulation::ForceState& force : held.state().forces)
    all[py::str(force.name)] = force.work * omega * omega;
  return all;
}

py::dict counts(const Held& held) {
  const simulation::SimulationState& state = held.state();
  py::dict numbers;
  numbers["collisions"] = state.collisions.fast;
  numbers["slow_contacts"] = state.collisions.slow;
  numbers["steps"] = state.control.steps;
  return numbers;
}

} // namespace

void bind_simulation(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ContactRecord, time_orbits, low_id, high_id, x_m, y_m, z_m, normal_speed_m_s,
                       tangential_speed_m_s, energy_lost_j);
  py::class_<Held>(module, "Simulation")
      .def(py::init(&from_scene), py::arg("scene"))
      .def(py::init(&from_snapshot), py::arg("snapshot"), py::arg("name"), py::arg("scene"))
      .def_static("load", [](const std::filesystem::path& file) { return from_stored(runs::load_checkpoint(file)); })
      .def_static("resume", &resume, py::arg("folder"), py::arg("notice"))
      .def("__len__", [](const Held& held) { return held.state().particles.size(); })
      .def_property_readonly("scene", &Held::scene, py::return_value_policy::reference_internal)
      .def_property_readonly("orbits", &orbits)
      .def_property_readonly(
          "box", [](const Held& held) { return std::pair(held.state().box.size_x, held.state().box.size_y); })
      .def_property_readonly("shear_offset", [](const Held& held) { return held.simulation().offset_at_break(); })
      .def_property_readonly("tick", [](const Held& held) { return held.state().step; })
      .def_property_readonly(
          "epoch",
          [](const Held& held) { return held.simulation().orbits() + 0.5 * held.state().step_length / two_pi; })
      .def_property_readonly("state_hash",
                             [](const Held& held) {
                               require_own_threads();
                               return runs::state_hash(held.whole_state(), held.scene());
                             })
      .def("advance", &Held::advance, py::arg("until_tick"))
      .def("elements", &elements)
      .def("radii", &of_bodies<&Body::radius>)
      .def("masses", &of_bodies<&Body::mass>)
      .def("ids", &ids)
      .def("motion", &motion)
      .def("spins", &spins)
      .def("snapshot", &snapshot)
      .def("replace", &replace, py::arg("positions"), py::arg("velocities"), py::arg("radii"), py::arg("masses"),
           py::arg("spins"))
      .def("record_contacts", &Held::record_contacts, py::arg("minimum_speed"))
      .def("take_contacts", &contacts)
      .def("save", &save, py::arg("file"))
      .def("open_view", &Held::open_view, py::arg("title"), py::arg("port"))
      .def("close_view", &Held::close_view)
      .def("counts", &counts)
      .def("works", &works);
}

} // namespace keeler::python
