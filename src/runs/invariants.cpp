#include "invariants.hpp"

#include "reference_forces.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/random.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/particles/order.hpp>

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::runs {
namespace {

bool is_finite(const Elements& el) {
  return std::isfinite(el.guiding_x) && std::isfinite(el.guiding_y) && std::isfinite(el.e_cos) &&
         std::isfinite(el.e_sin) && std::isfinite(el.i_sin) && std::isfinite(el.i_cos);
}

std::array<double, 6> components(const Elements& el) {
  return {el.guiding_x, el.guiding_y, el.e_cos, el.e_sin, el.i_sin, el.i_cos};
}

// The change of a particle's elements in the step that ends with `now`, beyond kicks, orbital drift and wraps, referred
// to the first epoch after the step.
class CollisionalChange {
public:
  CollisionalChange(const BeforeStep& before, const simulation::SimulationState& now, const Frequencies& f)
      : before_(before), now_(now), frequencies_(f), boundary_(f, -0.5 * before.state.step_length),
        step_(f, before.state.step_length), back_(f, -0.5 * (now.step_length - before.state.step_length)),
        offset_(before.state.box.offset(2 * now.step + before.state.control.step, 0.5 * before.state.tick())) {}

  // The arguments are the particle's indices in the two states.
  Elements operator()(std::size_t index_before, std::size_t index_now) const {
    Elements expected = before_.state.particles.bodies[index_before].elements;
    half_kicks(before_.state, index_before, 1.0, expected);
    step_(expected);
    Elements found = now_.particles.bodies[index_now].elements;
    if (now_.step_length != before_.state.step_length)
      back_(found);
    half_kicks(now_, index_now, -1.0, found);
    const ShearingBox& box = before_.state.box;
    Elements change = found - expected;
    change = box.image_of(change, {-nearest(change.guiding_x / box.size_x), 0}, offset_);
    return box.image_of(change, {0, -nearest(change.guiding_y / box.size_y)}, offset_);
  }

private:
  static std::int32_t nearest(double boxes) {
    return std::fabs(boxes) < 1e9 ? static_cast<std::int32_t>(std::lrint(boxes)) : 0;
  }

  // Applies the half kicks of all forces that kick at this boundary.
  void half_kicks(const simulation::SimulationState& state, std::size_t index, double sign, Elements& el) const {
    for (std::size_t f = 0; f < state.forces.size(); ++f) {
      const std::int64_t ticks = before_.kick_ticks[f];
      if (state.step % ticks == 0)
        kick(el, sign * 0.5 * before_.state.tick() * static_cast<double>(ticks) * state.forces[f].accelerations[index],
             frequencies_, boundary_);
    }
  }

  const BeforeStep& before_;
  const simulation::SimulationState& now_;
  Frequencies frequencies_;
  Rotation boundary_;
  hill::Rebase step_, back_;
  double offset_;
};

} // namespace

double energy_scale(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means,
                    const Frequencies& f) {
  const double part = f.shear() / (f.kappa * f.kappa);
  const CollisionTally& tally = state.collisions;
  double scale = means.epicyclic_energy + std::fabs(means.spin.energy) + state.energy.epicyclic +
                 std::fabs(state.energy.spin) + std::fabs(tally.energy_lost) +
                 f.shear() * std::fabs(tally.momentum_flux) + part * std::fabs(tally.azimuthal_gain) +
                 std::fabs(state.resting.work);
  for (const simulation::ForceState& force : state.forces)
    scale += std::fabs(force.work) + part * std::fabs(force.azimuthal_gain);
  return scale;
}

std::string fault_of_budget(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means,
                            const Frequencies& f) {
  const double residual = state.balance(means, f).residual;
  if (!std::isfinite(residual)) {
    const std::string numbers = fault_of_numbers(state);
    return numbers.empty() ? "the energy budget is not finite" : numbers;
  }
  const double scale = energy_scale(state, means, f);
  if (std::fabs(residual) <= allowed_residual * scale)
    return {};
  return fmt::format("the energy budget does not close: residual {} of its sums since the run began ({:g} is allowed)",
                     format_number(std::fabs(residual) / scale, 2), allowed_residual);
}

std::string fault_of_numbers(const simulation::SimulationState& state) {
  const Particles& particles = state.particles;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    if (!is_finite(particles.bodies[k].elements))
      return fmt::format("particle {} has elements that are not finite", particles.ids[k]);
    if (particles.rough && !particles.spins[k].allFinite())
      return fmt::format("particle {} has a spin that is not finite", particles.ids[k]);
    for (const simulation::ForceState& force : state.forces)
      if (!force.accelerations.empty() && !force.accelerations[k].allFinite())
        return fmt::format("particle {} has an acceleration by {} that is not finite", particles.ids[k], force.name);
  }
  return {};
}

std::string fault_of_overlap(const cells::Overlap& overlap) {
  if (overlap.depth <= cells::allowed_overlap)
    return {};
  return fmt::format("particles {} and {} overlap by {} of their radius sum ({:g} is allowed)", overlap.id_i,
                     overlap.id_j, format_number(overlap.depth, 2), cells::allowed_overlap);
}

std::string fault_of_neighbours(const collision::NeighbourAudit& audit) {
  if (!audit.missed)
    return {};
  const collision::MissedNeighbour& missed = *audit.missed;
  return fmt::format("particle {} may touch particle {} (image {}, {}), {} radius sums from it in the middle of the "
                     "step, and {}",
                     missed.id, missed.other_id, missed.image.nx, missed.image.ny, format_number(missed.distance, 3),
                     missed.after_hit ? "was not searched against it after a collision"
                                      : "is not among its neighbours when the step begins");
}

BeforeStep before_step(const Simulation& simulation) {
  BeforeStep before{simulation.state(), {}, simulation.balance().residual};
  for (std::size_t f = 0; f < before.state.forces.size(); ++f)
    before.kick_ticks.push_back(simulation.ticks_between_kicks(f));
  return before;
}

std::string fault_of_particles(const simulation::SimulationState& before, const simulation::SimulationState& now) {
  if (before.particles.size() != now.particles.size())
    return fmt::format("there are {} particles, and were {}", now.particles.size(), before.particles.size());
  const std::vector<std::uint32_t> order = particles::order_by_id(now.particles.ids),
                                   then = particles::order_by_id(before.particles.ids);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint64_t id = before.particles.ids[then[k]];
    if (now.particles.ids[order[k]] != id)
      return fmt::format("particle {} is missing", id);
    const Body &body = now.particles.bodies[order[k]], &was = before.particles.bodies[then[k]];
    if (body.radius != was.radius || body.mass != was.mass)
      return fmt::format("particle {} has another radius or mass than before", id);
  }
  return {};
}

simulation::SimulationState dealt_by_id(const simulation::SimulationState& state, const Communicator& ranks) {
  const auto dealt = [&](const auto& rows) {
    using Row = typename std::remove_cvref_t<decltype(rows)>::value_type;
    std::vector<std::vector<Row>> sent(ranks.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      sent[state.particles.ids[k] % ranks.size()].push_back(rows[k]);
    std::vector<Row> received;
    for (const std::vector<Row>& some : ranks.exchange(sent))
      received.insert(received.end(), some.begin(), some.end());
    return received;
  };
  simulation::SimulationState result = state;
  result.particles.bodies = dealt(state.particles.bodies);
  result.particles.ids = dealt(state.particles.ids);
  result.particles.spins = dealt(state.particles.spins);
  for (std::size_t f = 0; f < state.forces.size(); ++f)
    result.forces[f].accelerations = dealt(state.forces[f].accelerations);
  return result;
}

std::string fault_of_energy(const BeforeStep& before, const simulation::SimulationState& now,
                            const diagnostics::ParticleMeans& means, const Frequencies& f) {
  const double change = std::fabs(now.balance(means, f).residual - before.residual),
               scale = energy_scale(now, means, f);
  if (change <= allowed_residual_of_step * scale)
    return {};
  return fmt::format("the energy budget of the step does not close: residual {} of its sums ({:g} is allowed)",
                     format_number(change / scale, 2), allowed_residual_of_step);
}

std::string fault_of_sums(const BeforeStep& before, const simulation::SimulationState& now, const Frequencies& f,
                          const Communicator& ranks) {
  constexpr std::array<const char*, 6> names = {"m X", "m Y", "m e cos", "m e sin", "m i sin", "m i cos"};
  constexpr double tolerance = 1e-10; // over the summed magnitudes of single particles' changes
  constexpr double epsilon = std::numeric_limits<double>::epsilon(), roundings = 64.0;
  assert(before.state.particles.size() == now.particles.size());
  assert(before.kick_ticks.size() == now.forces.size());
  const CollisionalChange collisional_change(before, now, f);
  const ShearingBox& box = now.box;
  const std::vector<std::uint32_t> order = particles::order_by_id(now.particles.ids),
                                   then = particles::order_by_id(before.state.particles.ids);
  std::array<ExactSum, 6> all_sums, all_sizes, all_rounding;
  bool displaced_far = false; // a collisional change could be mistaken for a wrap
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Body& body = now.particles.bodies[order[k]];
    const std::array<double, 6> change = components(collisional_change(then[k], order[k])),
                                values = components(body.elements);
    const double displaced = std::hypot(change[2], change[3]); // bounds the change of X; of Y with velocity and X
    displaced_far |= displaced > 0.25 * box.size_x ||
                     (2.0 / f.kappa + f.shear() * before.state.step_length) * displaced > 0.25 * box.size_y;
    for (std::size_t c = 0; c < change.size(); ++c) {
      const double position = c == 0 ? box.size_x : c == 1 ? box.size_x + box.size_y : 0.0;
      all_sums[c] += body.mass * change[c];
      all_sizes[c] += body.mass * std::fabs(change[c]);
      all_rounding[c] += roundings * epsilon * body.mass * (std::fabs(values[c]) + position);
    }
  }
  std::array<double, 6> sums{}, sizes{}, rounding{};
  for (std::size_t c = 0; c < sums.size(); ++c) {
    ranks.merge({&all_sums[c], &all_sizes[c], &all_rounding[c]});
    sums[c] = all_sums[c].value();
    sizes[c] = all_sizes[c].value();
    rounding[c] = all_rounding[c].value();
  }
  displaced_far = ranks.any(displaced_far);
  const double vectors = rounding[2] + rounding[3] + rounding[4] + rounding[5]; // a rotation mixes the components
  for (std::size_t c = displaced_far ? 2 : 0; c < sums.size(); ++c) {
    const double allowed = tolerance * sizes[c] + (c < 2 ? rounding[c] + vectors : vectors);
    if (!(std::fabs(sums[c]) <= allowed))
      return fmt::format("collisions changed the sum of {} by {} kg m ({} is allowed)", names[c],
                         format_number(sums[c], 2), format_number(allowed, 2));
  }
  return {};
}

namespace {

// The error of the forces on a sample, over the rms force.
struct SampledError {
  double relative = 0.0;
  std::size_t sampled = 0;
  std::uint64_t worst_id = 0;
};

SampledError sampled_error(const Scene& scene, const gravity::GravityProblem& problem, double mass_of_all, double area,
                           const simulation::SimulationState& state, const std::vector<std::size_t>& places) {
  gravity::ImageSettings images = reference_images(*scene.gravity);
  if (sums_over_pairs(*scene.gravity) && !scene.gravity->images.far)
    images = scene.gravity->images;
  const ComparedForces compared =
      compare_forces(problem, state.forces.front().accelerations, places, *scene.gravity, images);
  double errors = 0.0, squares = 0.0, worst = 0.0;
  std::size_t worst_at = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double error = (compared.found[k] - compared.exact[k]).squaredNorm();
    errors += error;
    squares += compared.exact[k].squaredNorm();
    if (!(error <= worst)) {
      worst = error;
      worst_at = k;
    }
  }
  // in a sparse patch the forces nearly cancel: the scale is then the force of a uniform sheet
  const double sheet = problem.newton_g * mass_of_all / area;
  const double size = std::max(std::sqrt(squares / static_cast<double>(places.size())), sheet);
  return {std::sqrt(errors / static_cast<double>(places.size())) / size, places.size(), compared.ids[worst_at]};
}

} // namespace

std::string fault_of_forces(const Scene& scene, const forces::Boundary& boundary,
                            const simulation::SimulationState& state) {
  const double tolerance = scene.gravity ? force_tolerance(*scene.gravity) : 0.0;
  const std::size_t count = boundary.ranks.sum(state.particles.size());
  if (tolerance == 0.0 || count == 0)
    return {};
  std::vector<Vec3> positions;
  std::vector<double> masses;
  const gravity::GravityProblem problem = gravity_problem(boundary, scene.planet.orbital_frequency, positions, masses);
  auto masses_of_all = exact_total<ExactSum>(masses.size(), [&](ExactSum& sum, std::size_t k) { sum += masses[k]; });
  boundary.ranks.merge({&masses_of_all});
  RandomStream random(static_cast<std::uint64_t>(state.step), RandomPurpose::sample, 1);
  SampledError error;
  // A tree errs by ten times the rms on one particle of a thousand, which a small sample may hold: a larger one
  // decides.
  for (const std::size_t sampled : {std::size_t{32}, std::size_t{1024}}) {
    std::vector<std::size_t> places; // in the order of ids
    for (std::size_t k = 0; k < std::min(sampled, count); ++k)
      places.push_back(count <= sampled ? k : static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
    error = sampled_error(scene, problem, masses_of_all.value(), boundary.box.area(), state, places);
    if (error.relative <= forces_factor * tolerance)
      return {};
  }
  return fmt::format(
      "the forces on {} have a relative rms error of {}, largest on particle {} ({} is allowed: {:g} times "
      "the solver's tolerance)",
      pluralize(error.sampled, "particle"), format_number(error.relative, 3), error.worst_id,
      format_number(forces_factor * tolerance, 3), forces_factor);
}

} // namespace keeler::runs
