#include <keeler/contact_solver/resting_contacts.hpp>

#include "bounded_impulses.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

constexpr double min_gap = 0.05;      // that a pair is given, in what the kick of its own gravity moves it by
constexpr double gap_tolerance = 0.4; // of that
constexpr double longest_fall = 0.12; // of a pair between two kicks, in radius sums: a longer one is not at rest
constexpr int max_corrections = 10;   // of the linear prediction of gaps

/// A particle that rests, or may.
struct Member {
  std::uint64_t id = 0;
  std::uint32_t place = 0; // in memory
};

/// A pair at this boundary.
struct PairAtRest {
  RestingPair ids;
  std::uint32_t low = 0, high = 0; // members
  double impulse = 0.0;            // at the last boundary
  bool is_new = false;

  Image image;                    // of the high one, the nearest
  Elements relative;              // of the high one against the low one, with the kicks of the interval to come
  Vec3 separation = Vec3::Zero(); // m
  Vec3 normal = Vec3::Zero();
  double radius_sum = 0.0, gap = 0.0; // m
  double speed = 0.0;                 // along the normal before the kick, positive where they part, m rad⁻¹
  double kick = 0.0;                  // what the kick adds to it
  double pull = 0.0;                  // of the pair's own gravity: what a kick adds, m rad⁻¹
  double least = 0.0, target = 0.0;   // gap at the next boundary: beyond the room for the curvature, and in all, m
  double allowed = 0.0;               // closing speed before the kick up to which it rests, m rad⁻¹
};

} // namespace

void RestingState::list_fields(FieldTable& table) {
  table.rows<std::uint64_t>("resting_pairs", pairs, "1", "ids of pairs that rest on each other");
  table.rows<double>("resting_loads", loads, "m, kg m rad^-1", "separation of each; impulse of the last kick");
  table.scalar("resting_strongest", strongest, "1", "of the impulses, in kicks of the pair's own gravity");
  table.scalar("resting_work", work, "kg m^2 rad^-2", "work of the impulses at rest on relative motions");
}

struct RestingContacts::Work {
  std::vector<Member> members; // sorted by id
  std::vector<double> inverse_masses;
  std::vector<Vec3> kicks_before, kicks_after; // of each member, m rad⁻¹
  std::vector<Vec3> pushes;                    // by all impulses
  std::vector<PairAtRest> pairs;
  RestingCosts costs;

  void find_members(const RestingState& state, const std::vector<Noted>& noted, const Particles& particles,
                    bool places_known);
  void read_kicks(const RestingStep& step);
  void list_pairs(const RestingState& state, std::vector<Noted>& noted);
  void look(const RestingStep& step);
  void rub(const RestingStep& step, const Friction& friction, CollisionTally& tally);
  void judge(const RestingStep& step);
  void solve(const RestingStep& step);
  void give(RestingState& state, const RestingStep& step, const std::vector<Vec3>& kicks, bool after,
            CollisionTally& tally);

  void forget_others();

  const Body& body(const RestingStep& step, std::uint32_t member) const {
    return step.particles.bodies[members[member].place];
  }
  std::vector<Member>::const_iterator find(std::uint64_t id) const {
    return std::lower_bound(members.begin(), members.end(), id,
                            [](const Member& m, std::uint64_t wanted) { return m.id < wanted; });
  }
  bool rests(std::uint64_t id) const {
    const auto found = find(id);
    return found != members.end() && found->id == id;
  }
  std::uint32_t member(std::uint64_t id) const {
    assert(rests(id));
    return static_cast<std::uint32_t>(find(id) - members.begin());
  }
  // Along the line of centres, how fast the members part by `changes` of their velocities.
  static double parting(const PairAtRest& p, const std::vector<Vec3>& changes) {
    return p.normal.dot(changes[p.high] - changes[p.low]);
  }
  // At the next kick, when the members get these pushes.
  double gap_then(const PairAtRest& p, const RestingStep& step, const Rotation& now, const Rotation& then) const {
    Elements relative = p.relative;
    keeler::kick(relative, pushes[p.high] - pushes[p.low], step.frequencies, now);
    return state_at(relative, step.frequencies, then).position.norm() - p.radius_sum;
  }
};

RestingContacts::RestingContacts() = default;
RestingContacts::~RestingContacts() = default;
RestingContacts::RestingContacts(RestingContacts&& other) noexcept = default;
RestingContacts& RestingContacts::operator=(RestingContacts&& other) noexcept = default;

void RestingContacts::note(const Particles& particles, const SlowPair& pair) {
  const std::uint64_t low = particles.ids[pair.low], high = particles.ids[pair.high];
  if (pair.kicks < RestingState::slow || (work_ && (work_->rests(low) || work_->rests(high))))
    noted_.push_back({{low, high}, pair.low, pair.high});
}

const RestingCosts& RestingContacts::costs() const {
  static const RestingCosts none;
  return work_ ? work_->costs : none;
}

// Whoever rests or was noted, and where they are in memory. Only another memory order asks all particles.
void RestingContacts::Work::find_members(const RestingState& state, const std::vector<Noted>& noted,
                                         const Particles& particles, bool places_known) {
  const auto by_id = [](const Member& a, const Member& b) { return a.id < b.id; };
  if (!places_known)
    members.clear();
  for (const Noted& n : noted) {
    members.push_back({n.ids.low, n.low});
    members.push_back({n.ids.high, n.high});
  }
  if (!places_known)
    for (const RestingPair& p : state.pairs) {
      members.push_back({p.low, 0});
      members.push_back({p.high, 0});
    }
  std::sort(members.begin(), members.end(), by_id);
  members.erase(
      std::unique(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.id == b.id; }),
      members.end());
  if (!places_known)
    for (std::size_t place = 0; place < particles.size(); ++place) {
      const auto found = std::lower_bound(members.begin(), members.end(), Member{particles.ids[place], 0}, by_id);
      if (found != members.end() && found->id == particles.ids[place])
        found->place = static_cast<std::uint32_t>(place);
    }
  inverse_masses.clear();
  for (const Member& m : members) {
    assert(particles.ids[m.place] == m.id);
    inverse_masses.push_back(1.0 / particles.bodies[m.place].mass);
  }
}

void RestingContacts::Work::read_kicks(const RestingStep& step) {
  kicks_before.assign(members.size(), Vec3::Zero());
  kicks_after.assign(members.size(), Vec3::Zero());
  for (const KickPart& part : step.kicks)
    for (std::size_t m = 0; m < members.size(); ++m) {
      kicks_before[m] += part.before * part.accelerations[members[m].place];
      kicks_after[m] += part.after * part.accelerations[members[m].place];
    }
}

// Those at rest and those noted, each once, in the order of the ids.
void RestingContacts::Work::list_pairs(const RestingState& state, std::vector<Noted>& noted) {
  std::sort(noted.begin(), noted.end(), [](const Noted& a, const Noted& b) { return a.ids < b.ids; });
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

// Where the pairs are, and what the kick does to them.
void RestingContacts::Work::look(const RestingStep& step) {
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  for (PairAtRest& p : pairs) {
    const Body &a = body(step, p.low), &b = body(step, p.high);
    p.relative = b.elements - a.elements;
    const Vec3 apart = state_at(p.relative, f, now).position;
    // the offset of now that the images of the epoch have; no whole box along the orbit is dropped from it
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
    p.least = min_gap * p.pull * step.interval;
    p.speed = p.normal.dot(relative.velocity) - parting(p, kicks_before);
    p.kick = parting(p, kicks_before) + parting(p, kicks_after);
    kick(p.relative, kicks_after[p.high] - kicks_after[p.low], f, now);
  }
}

// The surfaces of those that carried something rub, as in a collision with that impulse.
void RestingContacts::Work::rub(const RestingStep& step, const Friction& friction, CollisionTally& tally) {
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  const SpinTurn turn(-step.to_epoch);
  for (const PairAtRest& p : pairs) {
    if (!(p.impulse > 0.0))
      continue;
    const std::uint32_t low = members[p.low].place, high = members[p.high].place;
    Body &a = step.particles.bodies[low], &b = step.particles.bodies[high];
    Vec3 &spin_a = step.particles.spins[low], &spin_b = step.particles.spins[high];
    const Elements relative = step.box.image_of(b.elements - a.elements, p.image, step.epoch_offset);
    const Vec3 velocity = state_at(relative, f, now).velocity;
    const Sliding sliding =
        slide(friction, {a, b, p.normal, velocity, turn.from_epoch(spin_a), turn.from_epoch(spin_b)}, p.impulse);
    const Vec3 to_low = -sliding.impulse / a.mass, to_high = sliding.impulse / b.mass;
    spin_a += turn.to_epoch(spin_change(a, p.normal, sliding.impulse));
    spin_b += turn.to_epoch(spin_change(b, p.normal, sliding.impulse));
    tally.energy_lost += sliding.energy_lost;
    tally.momentum_flux += p.separation.x() * sliding.impulse.y();
    tally.azimuthal_gain += azimuthal_gain(a, to_low, f, now);
    tally.azimuthal_gain += azimuthal_gain(b, to_high, f, now);
    kick(a.elements, to_low, f, now);
    kick(b.elements, to_high, f, now);
  }
}

// Who rests: whose rebound the kick undoes, and who is not hit so hard that the drift has to see it. Others go.
void RestingContacts::Work::judge(const RestingStep& step) {
  const Rotation now(step.frequencies, -step.to_epoch), then(step.frequencies, step.interval - step.to_epoch);
  const auto rests = [&](PairAtRest& p) {
    const double own = p.impulse * (inverse_masses[p.low] + inverse_masses[p.high]);
    const double pushed = parting(p, pushes), predicted = gap_then(p, step, now, then);
    const double curvature = predicted - p.gap - (p.speed + p.kick + pushed) * step.interval; // ½ a Δt²
    p.target = p.least + 0.25 * std::max(0.0, curvature);
    p.allowed = std::max(p.pull, own - pushed - p.kick); // what presses them together, all others' impulses included
    if (predicted < -longest_fall * p.radius_sum)
      return false;
    if (-p.speed > p.allowed)
      p.impulse = 0.0;
    return p.is_new ? predicted < p.target && -p.speed <= p.allowed : p.gap < p.target + p.allowed * step.interval;
  };
  std::vector<PairAtRest> resting;
  for (PairAtRest& p : pairs)
    if (rests(p))
      resting.push_back(p);
  pairs = std::move(resting);
}

// The impulses with which all pairs are where they should be at the next kick. Predicted to first order in the
// impulses, and corrected by what they do.
void RestingContacts::Work::solve(const RestingStep& step) {
  const Rotation now(step.frequencies, -step.to_epoch), then(step.frequencies, step.interval - step.to_epoch);
  std::vector<Joint> joints;
  std::vector<PairAtRest*> held;
  std::vector<double> impulses, required, tolerances;
  for (PairAtRest& p : pairs)
    if (-p.speed <= p.allowed) {
      joints.push_back({p.low, p.high, p.normal});
      held.push_back(&p);
      impulses.push_back(p.impulse);
      tolerances.push_back(gap_tolerance * p.least / step.interval);
    }
  required.resize(held.size());
  BoundedImpulses network(joints, inverse_masses);
  network.push(impulses, pushes);
  for (int correction = 0; correction < max_corrections; ++correction) {
    bool done = correction > 0;
    for (std::size_t c = 0; c < held.size(); ++c) {
      const PairAtRest& p = *held[c];
      const double open = (gap_then(p, step, now, then) - p.target) / step.interval;
      done = done && open >= -2.0 * tolerances[c] && (impulses[c] == 0.0 || open <= 2.0 * tolerances[c]);
      required[c] = parting(p, pushes) - open;
    }
    if (done)
      break;
    if (!network.solve(required, tolerances, impulses))
      throw InvariantError(
          fmt::format("no impulses carry the kick of {} contacts at rest; the particles are jammed in the box: make it "
                      "larger, or set gravity.resting_contacts to \"bounced\"",
                      held.size()));
    network.push(impulses, pushes);
  }
  for (std::size_t c = 0; c < held.size(); ++c)
    held[c]->impulse = impulses[c];
  costs.contacts = pairs.size();
  costs.iterations = network.iterations();
}

// Half of the impulses, beside half kicks that have just been given. The work of a kick is that at the mean velocity of
// all that acts with it: so each takes half of the cross terms, which went to what came later.
void RestingContacts::Work::give(RestingState& state, const RestingStep& step, const std::vector<Vec3>& kicks,
                                 bool after, CollisionTally& tally) {
  const Frequencies& f = step.frequencies;
  const Rotation now(f, -step.to_epoch);
  double work = 0.0, azimuthal = 0.0, flux = 0.0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    Body& body = step.particles.bodies[members[m].place];
    const Vec3 dv = 0.5 * pushes[m];
    work += body.mass * dv.dot(peculiar_velocity(body.elements, f, now) + 0.5 * dv - 0.5 * kicks[m]);
    azimuthal += keeler::azimuthal_gain(body, dv, f, now) - body.mass * dv.y() * kicks[m].y();
    for (const KickPart& part : step.kicks) {
      const Vec3 its = (after ? part.after : part.before) * part.accelerations[members[m].place];
      *part.work += 0.5 * body.mass * dv.dot(its);
      *part.azimuthal_gain += body.mass * dv.y() * its.y();
    }
    kick(body.elements, dv, f, now);
  }
  for (const RestingLoad& load : state.loads)
    flux += 0.5 * load.impulse * load.separation.x() * load.separation.y() / load.separation.norm();
  tally.azimuthal_gain += azimuthal;
  tally.momentum_flux += flux;
  state.work += work - f.shear() * flux;
}

// Members that are in no pair.
void RestingContacts::Work::forget_others() {
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

void RestingContacts::carry(RestingState& state, const RestingStep& step, const std::optional<Friction>& friction,
                            CollisionTally& tally) {
  if (!work_)
    work_ = std::make_unique<Work>();
  Work& w = *work_;
  w.find_members(state, noted_, step.particles, places_known_);
  places_known_ = true;
  w.read_kicks(step);
  w.list_pairs(state, noted_);
  noted_.clear();
  w.look(step);
  if (friction && friction->tangential_restitution < 1.0) {
    w.rub(step, *friction, tally);
    w.look(step);
  }
  w.pushes.assign(w.members.size(), Vec3::Zero());
  for (const PairAtRest& p : w.pairs) {
    w.pushes[p.low] -= (p.impulse * w.inverse_masses[p.low]) * p.normal;
    w.pushes[p.high] += (p.impulse * w.inverse_masses[p.high]) * p.normal;
  }
  w.judge(step);
  w.solve(step);
  state.pairs.clear();
  state.loads.clear();
  state.strongest = 0.0;
  for (const PairAtRest& p : w.pairs) {
    state.pairs.push_back(p.ids);
    state.loads.push_back({p.separation, p.impulse});
    state.strongest =
        std::max(state.strongest, p.impulse * (w.inverse_masses[p.low] + w.inverse_masses[p.high]) / p.pull);
  }
  w.give(state, step, w.kicks_before, false, tally);
  w.forget_others();
  if (state.pairs.empty())
    work_.reset();
}

void RestingContacts::carry_on(RestingState& state, const RestingStep& step, CollisionTally& tally) {
  if (state.pairs.empty())
    return;
  if (!work_)
    work_ = std::make_unique<Work>();
  Work& w = *work_;
  w.find_members(state, {}, step.particles, places_known_);
  places_known_ = true;
  w.read_kicks(step);
  w.pushes.assign(w.members.size(), Vec3::Zero());
  for (std::size_t k = 0; k < state.pairs.size(); ++k) {
    const std::uint32_t low = w.member(state.pairs[k].low), high = w.member(state.pairs[k].high);
    const Vec3 impulse = (state.loads[k].impulse / state.loads[k].separation.norm()) * state.loads[k].separation;
    w.pushes[low] -= w.inverse_masses[low] * impulse;
    w.pushes[high] += w.inverse_masses[high] * impulse;
  }
  w.give(state, step, w.kicks_after, true, tally);
}

} // namespace keeler
