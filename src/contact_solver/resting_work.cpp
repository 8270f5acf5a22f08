#include "resting_work.hpp"

#include "bounded_impulses.hpp"
#include "clusters.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>

#include <cmath>

namespace keeler::contact_solver {
namespace {

constexpr double min_gap_kicks = 0.05; // smallest target gap, in the displacement by a kick of the pair's gravity
constexpr double gap_tolerance = 0.4;  // fraction of it
constexpr double longest_fall = 0.12;  // in radius sums per kick interval: a pair that falls farther is not at rest
constexpr int max_corrections = 10;    // of the linear prediction of gaps

} // namespace

// Lists the particles of pairs at rest and of noted pairs, with their indices. Visits all particles only after a change
// of the memory order.
void RestingContacts::Work::find_members(const RestingState& state, const std::vector<Noted>& noted,
                                         const Particles& particles, bool indices_known) {
  assert(state.pairs.size() == state.loads.size());
  const auto by_id = [](const Member& a, const Member& b) { return a.id < b.id; };
  if (!indices_known)
    members.clear();
  for (const Noted& n : noted) {
    members.push_back({n.ids.low, n.low});
    members.push_back({n.ids.high, n.high});
  }
  if (!indices_known)
    for (const RestingPair& p : state.pairs) {
      members.push_back({p.low, 0});
      members.push_back({p.high, 0});
    }
  std::sort(members.begin(), members.end(), by_id);
  members.erase(
      std::unique(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.id == b.id; }),
      members.end());
  if (!indices_known)
    for (std::size_t index = 0; index < particles.size(); ++index) {
      const auto found = std::lower_bound(members.begin(), members.end(), Member{particles.ids[index], 0}, by_id);
      if (found != members.end() && found->id == particles.ids[index])
        found->index = static_cast<std::uint32_t>(index);
    }
  inverse_masses.clear();
  for (const Member& m : members) {
    assert(particles.ids[m.index] == m.id);
    inverse_masses.push_back(1.0 / particles.bodies[m.index].mass);
  }
}

void RestingContacts::Work::read_kicks(const RestingStep& step) {
  kicks_before.assign(members.size(), Vec3::Zero());
  kicks_after.assign(members.size(), Vec3::Zero());
  for (const KickPart& part : step.kicks) {
    assert(part.accelerations.size() == step.particles.size() && part.work && part.azimuthal_gain);
    for (std::size_t m = 0; m < members.size(); ++m) {
      kicks_before[m] += part.before * part.accelerations[members[m].index];
      kicks_after[m] += part.after * part.accelerations[members[m].index];
    }
  }
}

// Merges the pairs at rest with the noted ones, each once, in the order of the ids.
void RestingContacts::Work::list_pairs(const RestingState& state, const std::vector<Noted>& noted) {
  assert(std::is_sorted(state.pairs.begin(), state.pairs.end()));
  pairs.clear();
  const auto add = [&](const RestingPair& ids, double impulse, bool is_new) {
    PairAtRest p;
    p.ids = ids;
    p.low = member(ids.low);
    p.high = member(ids.high);
    p.impulse = impulse;
    p.is_new = is_new;
    pairs.push_back(p);
  };
  std::size_t next = 0;
  for (std::size_t k = 0; k <= state.pairs.size(); ++k) {
    const bool last = k == state.pairs.size();
    for (; next < noted.size() && (last || noted[next].ids < state.pairs[k]); ++next)
      if (pairs.empty() || pairs.back().ids != noted[next].ids)
        add(noted[next].ids, 0.0, true);
    if (!last)
      add(state.pairs[k], state.loads[k].impulse, false);
  }
}

// Computes the geometry of each pair and the change of its relative speed by the kick.
void RestingContacts::Work::update_geometry(const RestingStep& step) {
  assert(step.interval > 0.0);
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  for (PairAtRest& p : pairs) {
    const Body &a = body(step, p.low), &b = body(step, p.high);
    p.relative = b.elements - a.elements;
    const Vec3 apart = state_at(p.relative, f, now).position;
    // the offset at this boundary of the images that the epoch has: not reduced modulo the box
    const double offset = step.epoch_offset - step.box.shear * step.box.size_x * step.to_epoch;
    p.image = step.box.image_into_cell(apart.x(), apart.y(), offset);
    p.relative = step.box.image_of(p.relative, p.image, step.epoch_offset);
    const State relative = state_at(p.relative, f, now);
    p.separation = relative.position;
    const double distance = p.separation.norm();
    p.normal = p.separation / distance;
    p.radius_sum = a.radius + b.radius;
    p.gap = distance - p.radius_sum;
    p.pull = step.gravity * step.interval * (a.mass + b.mass) / (p.radius_sum * p.radius_sum);
    p.min_gap = min_gap_kicks * p.pull * step.interval;
    p.speed = p.normal.dot(relative.velocity) - separation_speed(p, kicks_before);
    p.kick = separation_speed(p, kicks_before) + separation_speed(p, kicks_after);
    kick(p.relative, kicks_after[p.high] - kicks_after[p.low], f, now);
  }
}

// Applies friction to the pairs that had an impulse, as in a collision with that normal impulse.
void RestingContacts::Work::apply_friction(const RestingStep& step, const collision::Friction& friction,
                                           CollisionTally& tally) {
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  const particles::SpinTurn turn(-step.to_epoch);
  for (const PairAtRest& p : pairs) {
    if (!(p.impulse > 0.0))
      continue;
    const std::uint32_t low = members[p.low].index, high = members[p.high].index;
    Body &a = step.particles.bodies[low], &b = step.particles.bodies[high];
    Vec3 &spin_a = step.particles.spins[low], &spin_b = step.particles.spins[high];
    const Elements relative = step.box.image_of(b.elements - a.elements, p.image, step.epoch_offset);
    const Vec3 velocity = state_at(relative, f, now).velocity;
    const collision::Sliding sliding =
        slide(friction, {a, b, p.normal, velocity, turn.from_epoch(spin_a), turn.from_epoch(spin_b)}, p.impulse);
    const Vec3 to_low = -sliding.impulse / a.mass, to_high = sliding.impulse / b.mass;
    spin_a += turn.to_epoch(collision::spin_change(a, p.normal, sliding.impulse));
    spin_b += turn.to_epoch(collision::spin_change(b, p.normal, sliding.impulse));
    tally.energy_lost += sliding.energy_lost;
    tally.momentum_flux += p.separation.x() * sliding.impulse.y();
    tally.azimuthal_gain += azimuthal_gain(a, to_low, f, now);
    tally.azimuthal_gain += azimuthal_gain(b, to_high, f, now);
    kick(a.elements, to_low, f, now);
    kick(b.elements, to_high, f, now);
  }
}

// Keeps the pairs at rest: the kick reverses their rebound, and they approach too slowly to be a collision, which is
// left to the drift. Other pairs are dropped.
void RestingContacts::Work::classify_pairs(const RestingStep& step) {
  const Rotation now(step.frequencies, -step.to_epoch), then(step.frequencies, step.interval - step.to_epoch);
  const auto rests = [&](PairAtRest& p) {
    const double by_itself = p.impulse * (inverse_masses[p.low] + inverse_masses[p.high]);
    const double pushed = separation_speed(p, velocity_changes), predicted = gap_at_next_kick(p, step, now, then);
    const double curvature = predicted - p.gap - (p.speed + p.kick + pushed) * step.interval; // ½ a Δt²
    p.target = p.min_gap + 0.25 * std::max(0.0, curvature);
    p.max_closing_speed =
        std::max(p.pull, by_itself - pushed - p.kick); // pressure on the pair, by all other impulses too
    if (predicted < -longest_fall * p.radius_sum)
      return false;
    if (-p.speed > p.max_closing_speed)
      p.impulse = 0.0;
    return p.is_new ? predicted < p.target && -p.speed <= p.max_closing_speed
                    : p.gap < p.target + p.max_closing_speed * step.interval;
  };
  std::vector<PairAtRest> resting;
  for (PairAtRest& p : pairs)
    if (rests(p))
      resting.push_back(p);
  pairs = std::move(resting);
}

// Finds the impulses that bring all pairs to their targets at the next kick. Clusters do not depend on each other, so
// each takes only the iterations that it needs.
void RestingContacts::Work::solve(const RestingStep& step) {
  std::vector<Joint> joints;
  std::vector<PairAtRest*> held;
  for (PairAtRest& p : pairs)
    if (-p.speed <= p.max_closing_speed) {
      joints.push_back({p.low, p.high, p.normal});
      held.push_back(&p);
    }
  std::fill(velocity_changes.begin(), velocity_changes.end(), Vec3::Zero());
  const Clusters clusters(joints, members.size());
  parallel_for(
      clusters.size(), [&](std::size_t k) { solve_cluster(clusters, k, held, step); }, 1);
}

// Solves one cluster: a prediction to first order in the impulses, corrected with exact epicycles.
void RestingContacts::Work::solve_cluster(const Clusters& clusters, std::size_t cluster,
                                          std::span<PairAtRest* const> all_held, const RestingStep& step) {
  const Rotation now(step.frequencies, -step.to_epoch), then(step.frequencies, step.interval - step.to_epoch);
  std::vector<Joint> joints;
  std::vector<PairAtRest*> held;
  std::vector<double> impulses, required, tolerances, own_inverse_masses;
  for (const std::uint32_t c : clusters.joints(cluster)) {
    PairAtRest& p = *all_held[c];
    joints.push_back({clusters.place(p.low), clusters.place(p.high), p.normal});
    held.push_back(&p);
    impulses.push_back(p.impulse);
    tolerances.push_back(gap_tolerance * p.min_gap / step.interval);
  }
  for (const std::uint32_t body : clusters.bodies(cluster))
    own_inverse_masses.push_back(inverse_masses[body]);
  required.resize(held.size());
  BoundedImpulses network(joints, own_inverse_masses);
  std::vector<Vec3> changes(own_inverse_masses.size());
  const auto apply_impulses = [&] {
    network.apply(impulses, changes);
    for (std::size_t b = 0; b < changes.size(); ++b)
      velocity_changes[clusters.bodies(cluster)[b]] = changes[b];
  };
  apply_impulses();
  for (int correction = 0; correction < max_corrections; ++correction) {
    bool done = correction > 0;
    for (std::size_t c = 0; c < held.size(); ++c) {
      const PairAtRest& p = *held[c];
      const double open = (gap_at_next_kick(p, step, now, then) - p.target) / step.interval;
      done = done && open >= -2.0 * tolerances[c] && (impulses[c] == 0.0 || open <= 2.0 * tolerances[c]);
      required[c] = separation_speed(p, velocity_changes) - open;
    }
    if (done)
      break;
    if (!network.solve(required, tolerances, impulses))
      throw InvariantError(
          "no impulses balance the kick of contacts at rest (the particles are jammed in the box); make "
          "the box larger, or set gravity.resting_contacts to \"bounced\"");
    apply_impulses();
  }
  for (std::size_t c = 0; c < held.size(); ++c)
    held[c]->impulse = impulses[c];
}

// Applies half of the impulses, next to the half kicks. Impulses and kicks act together and do their work at the mean
// velocity: so each takes half of the cross terms, which a sequence would book to the later one.
void RestingContacts::Work::distribute(RestingState& state, const RestingStep& step, const std::vector<Vec3>& kicks,
                                       bool after, CollisionTally& tally) {
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  double work = 0.0, azimuthal = 0.0, flux = 0.0;
  assert(kicks.size() == members.size() && velocity_changes.size() == members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    Body& body = step.particles.bodies[members[m].index];
    const Vec3 dv = 0.5 * velocity_changes[m];
    work += body.mass * dv.dot(peculiar_velocity(body.elements, f, now) + 0.5 * dv - 0.5 * kicks[m]);
    azimuthal += particles::azimuthal_gain(body, dv, f, now) - body.mass * dv.y() * kicks[m].y();
    for (const KickPart& part : step.kicks) {
      const Vec3 dv_force = (after ? part.after : part.before) * part.accelerations[members[m].index];
      *part.work += 0.5 * body.mass * dv.dot(dv_force);
      *part.azimuthal_gain += body.mass * dv.y() * dv_force.y();
    }
    kick(body.elements, dv, f, now);
  }
  for (const RestingLoad& load : state.loads)
    flux += 0.5 * load.impulse * load.separation.x() * load.separation.y() / load.separation.norm();
  tally.azimuthal_gain += azimuthal;
  tally.momentum_flux += flux;
  state.work += work - f.shear() * flux;
}

// Drops the members without a pair.
void RestingContacts::Work::drop_free_members() {
  std::vector<std::uint8_t> rests(members.size());
  for (const PairAtRest& p : pairs)
    rests[p.low] = rests[p.high] = 1;
  std::size_t kept = 0;
  for (std::size_t m = 0; m < members.size(); ++m)
    if (rests[m])
      members[kept++] = members[m];
  members.resize(kept);
  pairs.clear();
}

} // namespace keeler::contact_solver
