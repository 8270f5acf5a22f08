// Where moonlets are, on whatever rank, and how often they have gone round the box.
#include <keeler/simulation/simulation.hpp>

#include <cassert>
#include <cstring>

namespace keeler {

void Simulation::find_moonlets() {
  moonlet_places_.assign(state_.moonlets.size(), elsewhere);
  if (moonlet_places_.empty())
    return;
  for (std::size_t place = 0; place < state_.particles.size(); ++place)
    if (const std::uint64_t id = state_.particles.ids[place]; id >= first_moonlet())
      moonlet_places_[id - first_moonlet()] = place;
}

Body Simulation::moonlet(std::size_t k) const {
  Body body{};
  if (moonlet_places_[k] != elsewhere)
    body = state_.particles.bodies[moonlet_places_[k]];
  if (ranks_.distributed()) {
    double numbers[sizeof(Body) / sizeof(double)];
    static_assert(sizeof numbers == sizeof body);
    std::memcpy(numbers, &body, sizeof body);
    from_owners(numbers);
    std::memcpy(static_cast<void*>(&body), numbers, sizeof body);
  }
  return body;
}

// What owners of moonlets have, to all ranks; the numbers of others are 0.
void Simulation::from_owners(std::span<double> numbers) const {
  std::vector<std::uint64_t> bits(numbers.size());
  std::memcpy(bits.data(), numbers.data(), numbers.size_bytes());
  ranks_.sum(std::span(bits));
  std::memcpy(numbers.data(), bits.data(), numbers.size_bytes());
}

// Of a particle that has gone round an edge, whoever it is. Rare: it stays out of the loop over all of them.
[[gnu::noinline]] void Simulation::note_wrap(std::size_t k, const Vec3& shift) {
  const std::uint64_t id = state_.particles.ids[k];
  if (id < first_moonlet())
    return;
  assert(id - first_moonlet() < state_.moonlets.size());
  double* const wrap = &moonlet_wraps_[2 * (id - first_moonlet())];
  wrap[0] = shift.x();
  wrap[1] = shift.y();
}

// The wraps that were noted, into the tracks.
void Simulation::wrap_moonlets() {
  if (moonlet_wraps_.empty())
    return;
  from_owners(moonlet_wraps_);
  for (std::size_t k = 0; k < state_.moonlets.size(); ++k) {
    state_.moonlets[k].shift_x += moonlet_wraps_[2 * k];
    state_.moonlets[k].shift_y += moonlet_wraps_[2 * k + 1];
  }
}

} // namespace keeler
