#include <keeler/contact_solver/resting_contacts.hpp>
#include <keeler/core/field_table.hpp>

#include "resting_work.hpp"

#include <algorithm>
#include <cassert>

namespace keeler::contact_solver {

void RestingState::list_fields(FieldTable& table) {
  table.rows<std::uint64_t>("resting_pairs", pairs, "1", "ids of pairs that rest on each other");
  table.rows<double>("resting_loads", loads, "m, kg m rad^-1", "separation of each; impulse of the last kick");
  table.scalar("resting_strongest", strongest, "1", "of the impulses, in kicks of the pair's own gravity");
  table.scalar("resting_work", work, "kg m^2 rad^-2", "work of the impulses at rest on relative motions");
}

RestingContacts::RestingContacts() = default;
RestingContacts::~RestingContacts() = default;
RestingContacts::RestingContacts(RestingContacts&& other) noexcept = default;
RestingContacts& RestingContacts::operator=(RestingContacts&& other) noexcept = default;

void RestingContacts::note(const Particles& particles, const collision::SlowPair& pair) {
  const std::uint64_t low = particles.ids[pair.low], high = particles.ids[pair.high];
  assert(low < high);
  if (pair.kicks < RestingState::slow || (work_ && (work_->rests(low) || work_->rests(high))))
    noted_.push_back({{low, high}, pair.low, pair.high});
}

// Sorts the recorded pairs by ids and drops repetitions: a pair may touch many times in an interval.
void RestingContacts::sort_noted() {
  std::sort(noted_.begin(), noted_.end(), [](const Noted& a, const Noted& b) { return a.ids < b.ids; });
  noted_.erase(std::unique(noted_.begin(), noted_.end(), [](const Noted& a, const Noted& b) { return a.ids == b.ids; }),
               noted_.end());
}

void RestingContacts::share_noted(const Communicator& ranks) {
  noted_ = ranks.gather_on_all(std::span<const Noted>(noted_));
  indices_known_ = false;
}

std::vector<std::uint64_t> RestingContacts::member_ids(const RestingState& state) const {
  std::vector<std::uint64_t> ids;
  for (const RestingPair& pair : state.pairs)
    ids.insert(ids.end(), {pair.low, pair.high});
  for (const Noted& noted : noted_)
    ids.insert(ids.end(), {noted.ids.low, noted.ids.high});
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

void RestingContacts::persist(RestingState& state, const RestingStep& step,
                              const std::optional<collision::Friction>& friction, CollisionTally& tally) {
  if (!work_)
    work_ = std::make_unique<Work>();
  Work& w = *work_;
  sort_noted();
  w.find_members(state, noted_, step.particles, indices_known_);
  indices_known_ = true;
  w.read_kicks(step);
  w.list_pairs(state, noted_);
  noted_.clear();
  w.update_geometry(step);
  if (friction && friction->tangential_restitution < 1.0) {
    w.apply_friction(step, *friction, tally);
    w.update_geometry(step);
  }
  w.velocity_changes.assign(w.members.size(), Vec3::Zero());
  for (const PairAtRest& p : w.pairs) {
    w.velocity_changes[p.low] -= (p.impulse * w.inverse_masses[p.low]) * p.normal;
    w.velocity_changes[p.high] += (p.impulse * w.inverse_masses[p.high]) * p.normal;
  }
  w.classify_pairs(step);
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
  w.distribute(state, step, w.kicks_before, false, tally);
  w.drop_free_members();
  if (state.pairs.empty())
    work_.reset();
}

void RestingContacts::persist_second_half(RestingState& state, const RestingStep& step, CollisionTally& tally,
                                          std::span<std::uint8_t> at_rest) {
  if (state.pairs.empty())
    return;
  assert(state.pairs.size() == state.loads.size() && step.interval > 0.0);
  if (!work_)
    work_ = std::make_unique<Work>();
  Work& w = *work_;
  w.find_members(state, {}, step.particles, indices_known_);
  indices_known_ = true;
  w.read_kicks(step);
  w.velocity_changes.assign(w.members.size(), Vec3::Zero());
  for (std::size_t k = 0; k < state.pairs.size(); ++k) {
    const std::uint32_t low = w.member(state.pairs[k].low), high = w.member(state.pairs[k].high);
    const Vec3 impulse = (state.loads[k].impulse / state.loads[k].separation.norm()) * state.loads[k].separation;
    w.velocity_changes[low] -= w.inverse_masses[low] * impulse;
    w.velocity_changes[high] += w.inverse_masses[high] * impulse;
  }
  for (std::size_t m = 0; m < w.members.size(); ++m)
    at_rest[w.members[m].index] = w.velocity_changes[m] != Vec3::Zero();
  w.distribute(state, step, w.kicks_after, true, tally);
}

} // namespace keeler::contact_solver
