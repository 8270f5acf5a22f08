// Moonlets: their indices, on any rank, and their wraps around the box.
#include <keeler/simulation/simulation.hpp>

#include <cassert>
#include <cstring>

namespace keeler::simulation {

void Simulation::find_moonlets() {
  moonlet_indices_.assign(state_.moonlets.size(), elsewhere);
  if (moonlet_indices_.empty())
    return;
  for (std::size_t index = 0; index < state_.particles.size(); ++index)
    if (const std::uint64_t id = state_.particles.ids[index]; id >= first_moonlet())
      moonlet_indices_[id - first_moonlet()] = index;
}

Body Simulation::moonlet(std::size_t k) const {
  assert(k < state_.moonlets.size());
  Body body{};
  if (moonlet_indices_[k] != elsewhere)
    body = state_.particles.bodies[moonlet_indices_[k]];
  if (ranks_.distributed()) {
    double numbers[sizeof(Body) / sizeof(double)];
    static_assert(sizeof numbers == sizeof body);
    std::memcpy(numbers, &body, sizeof body);
    sum_from_owners(numbers);
    std::memcpy(static_cast<void*>(&body), numbers, sizeof body);
  }
  return body;
}

// Sums the numbers over all ranks: the owner of a moonlet has its value, other ranks have 0.
void Simulation::sum_from_owners(std::span<double> numbers) const {
  std::vector<std::uint64_t> bits(numbers.size());
  std::memcpy(bits.data(), numbers.data(), numbers.size_bytes());
  ranks_.sum(std::span(bits));
  std::memcpy(numbers.data(), bits.data(), numbers.size_bytes());
}

// Records the wrap of a particle if it is a moonlet. Rare: kept out of the loop over all particles.
[[gnu::noinline]] void Simulation::note_wrap(std::size_t k, const Vec3& shift) {
  assert(k < state_.particles.size() && moonlet_wraps_.size() == 2 * state_.moonlets.size());
  const std::uint64_t id = state_.particles.ids[k];
  if (id < first_moonlet())
    return;
  assert(id - first_moonlet() < state_.moonlets.size());
  double* const wrap = &moonlet_wraps_[2 * (id - first_moonlet())];
  wrap[0] = shift.x();
  wrap[1] = shift.y();
}

// Adds the recorded wraps to the tracks.
void Simulation::wrap_moonlets() {
  if (moonlet_wraps_.empty())
    return;
  sum_from_owners(moonlet_wraps_);
  assert(moonlet_wraps_.size() == 2 * state_.moonlets.size());
  for (std::size_t k = 0; k < state_.moonlets.size(); ++k) {
    state_.moonlets[k].shift_x += moonlet_wraps_[2 * k];
    state_.moonlets[k].shift_y += moonlet_wraps_[2 * k + 1];
  }
}

} // namespace keeler::simulation
