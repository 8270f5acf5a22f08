// Contacts at rest in distributed runs: their clusters are solved on every rank, with copies of all particles that have
// such a contact (the members), and each rank keeps what happens to its own ones. docs/dev/ranks.md.
#include <keeler/simulation/simulation.hpp>

#include <keeler/contact_solver/resting_contacts.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::simulation {

// Returns the indices of the own particles among these, whose ids are ascending. `own`: the number of own particles.
std::vector<std::uint32_t> Simulation::own_among(std::span<const std::uint64_t> ids, std::size_t own) {
  const std::vector<std::uint64_t>& own_ids = state_.particles.ids;
  if (own_by_id_.empty())
    own_by_id_ = particles::order_by_id(std::span(own_ids).first(own));
  std::vector<std::uint32_t> indices;
  auto from = own_by_id_.begin();
  for (const std::uint64_t id : ids) {
    from = std::lower_bound(from, own_by_id_.end(), id,
                            [&](std::uint32_t k, std::uint64_t sought) { return own_ids[k] < sought; });
    if (from != own_by_id_.end() && own_ids[*from] == id)
      indices.push_back(*from);
  }
  return indices;
}

// Calls function(step) with all members, in the order of the ranks, on each rank, and keeps the own ones. What the
// function adds to the state is global: all ranks add the same.
void Simulation::with_members_of_ranks(std::span<const contact_solver::KickPart> parts,
                                       const std::function<void(const contact_solver::RestingStep&)>& function) {
  Particles& here = state_.particles;
  const std::vector<std::uint32_t> own = own_among(resting_->member_ids(state_.resting), here.size());
  const auto gathered = [&](const auto& rows) {
    using Row = typename std::remove_cvref_t<decltype(rows)>::value_type;
    std::vector<Row> some;
    for (const std::uint32_t k : own)
      some.push_back(rows[k]);
    return ranks_.gather_on_all(std::span<const Row>(some));
  };
  Particles members;
  members.bodies = gathered(here.bodies);
  members.ids = gathered(here.ids);
  members.rough = here.rough;
  if (here.rough)
    members.spins = gathered(here.spins);
  std::vector<std::vector<Vec3>> accelerations;
  std::vector<contact_solver::KickPart> of_members(parts.begin(), parts.end());
  for (const contact_solver::KickPart& part : parts)
    accelerations.push_back(gathered(part.accelerations));
  for (std::size_t f = 0; f < parts.size(); ++f)
    of_members[f].accelerations = accelerations[f];
  resting_->reordered();
  ranks_.together([&] { function(resting_step(members, of_members)); });

  std::size_t member = 0;
  for (const std::uint32_t k : own) {
    while (members.ids[member] != here.ids[k]) // own members follow each other
      ++member;
    here.bodies[k] = members.bodies[member];
    if (here.rough)
      here.spins[k] = members.spins[member];
  }
}

void Simulation::note_ids_at_rest(const Particles& members) {
  for (std::size_t m = 0; m < members.size(); ++m)
    if (at_rest_[m])
      ids_at_rest_.push_back(members.ids[m]);
  std::sort(ids_at_rest_.begin(), ids_at_rest_.end());
  at_rest_.clear();
}

// Marks the particles at rest among the own ones and the ghosts of the step to come.
void Simulation::mark_at_rest() {
  at_rest_.clear();
  if (ids_at_rest_.empty())
    return;
  const std::vector<std::uint64_t>& ids = state_.particles.ids;
  const std::size_t own = blocks_->ghosts().own;
  at_rest_.assign(ids.size(), 0);
  for (const std::uint32_t k : own_among(ids_at_rest_, own))
    at_rest_[k] = 1;
  for (std::size_t k = own; k < ids.size(); ++k)
    at_rest_[k] = std::binary_search(ids_at_rest_.begin(), ids_at_rest_.end(), ids[k]);
}

} // namespace keeler::simulation
