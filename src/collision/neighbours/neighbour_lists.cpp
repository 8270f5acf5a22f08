// When lists and pruning intervals begin, and how lists are updated.
#include "neighbour_lists.hpp"

#include <keeler/core/parallel.hpp>

#include <cassert>
#include <cmath>
#include <utility>

namespace keeler::collision {

bool NeighbourLists::begin(const Particles& particles, const ShearingBox& box, double offset, bool undisturbed) {
  assert(box.size_x > 0.0 && box.size_y > 0.0);
  undisturbed = undisturbed && !without(Acceleration::windows);
  references_.begin_step();
  interval_.begin_step();
  policy_.begin_step(undisturbed);
  const bool were_valid = std::exchange(valid_, false); // until nothing can throw any more
  const bool usable = were_valid && valid_for(particles, box, offset);
  last_box_ = box;
  last_offset_ = offset;
  step_.emplace(particles, frequencies_, box, offset, step_length_);
  reaches_far_ = false;
  bool updated = false;
  if (usable) {
    interval_.look_ahead(step());
    updated = undisturbed && !interval_.over() ? update(interval_.escaped()) : begin_interval();
  }
  valid_ = updated || rebuild(were_valid);
  interval_.clear_escaped();
  if (!valid_)
    step_.reset();
  assert(sound());
  return valid_;
}

// True if the previous lists are of these particles one step ago, as far as can be told without looking at them.
bool NeighbourLists::valid_for(const Particles& particles, const ShearingBox& box, double offset) const {
  if (references_.lifetime().over() || particles.size() != lists_.size() || box.size_x != last_box_.size_x ||
      box.size_y != last_box_.size_y || box.shear != last_box_.shear)
    return false;
  const double moved = (offset - last_offset_ - box.shear * box.size_x * step_length_) / box.size_y;
  return std::fabs(moved - std::rint(moved)) < 1e-9;
}

// Rebuilds all lists, with a lifetime for which nearest images suffice. Returns false if there is none.
bool NeighbourLists::rebuild(bool were_valid) {
  int lifetime = policy_.choose_lifetime(were_valid, references_.lifetime(), step_length_);
  while (!references_.rebuild(step(), lifetime, interval_.buffer()) && lifetime > 1)
    lifetime = policy_.halve_lifetime();
  return fill_lists();
}

void NeighbourLists::rebuild_for_step() {
  references_.rebuild(step(), 1, interval_.buffer());
  reaches_far_ = !fill_lists();
}

bool NeighbourLists::fill_lists() {
  ++counts_.rebuilds;
  if (!references_.cells().one_image())
    return false;
  const ListRebuild done = rebuild_lists(references_.cells(), references_.lifetime().half(step_length_), lists_);
  policy_.rebuilt_all(lists_.size(), done.tested, done.entries);
  counts_.tested += done.tested;
  counts_.listed += done.entries / 2;
  interval_.resize(lists_.size());
  return begin_interval();
}

// Makes all lines, updates the lists of escaped particles, and prunes. Returns false as update().
bool NeighbourLists::begin_interval() {
  const int length = policy_.pruning_interval(interval_.dirty().size(), lists_.size(), interval_.steps().age,
                                              references_.lifetime(), step_length_);
  if (!update(interval_.begin(step(), length, references_)))
    return false;
  policy_.pruned(interval_.prune(lists_, step_length_));
  return true;
}

// Gives escaped particles new reference paths and lists. Returns false if it is cheaper to rebuild all lists, or if one
// of the particles reaches beyond the nearest image.
bool NeighbourLists::update(std::span<const std::uint32_t> escaped) {
  if (references_.lifetime().age > 0 &&
      (policy_.better_rebuild_all(escaped.size(), lists_.size()) || lists_.outgrown()))
    return false;
  policy_.updated(escaped.size());
  const Rotation to_middle = references_.to_middle_of_rest(step());
  for (const std::uint32_t i : escaped)
    if (!renew_path(i, to_middle))
      return false;
  struct Found {
    std::vector<std::uint32_t> entries, counts;
    std::uint64_t tested = 0;
  };
  constexpr std::size_t chunk = 64;
  std::vector<Found> found((escaped.size() + chunk - 1) / chunk);
  parallel_for(
      found.size(),
      [&](std::size_t c) {
        Found& some = found[c];
        std::vector<std::uint32_t> buffer;
        for (const std::uint32_t i : escaped.subspan(c * chunk, std::min(chunk, escaped.size() - c * chunk))) {
          const auto entries = references_.find_neighbours(step(), i, buffer, some.tested);
          some.entries.insert(some.entries.end(), entries.begin(), entries.end());
          some.counts.push_back(static_cast<std::uint32_t>(entries.size()));
        }
      },
      1);
  std::size_t next = 0;
  for (const Found& some : found) {
    counts_.tested += some.tested;
    std::span<const std::uint32_t> entries = some.entries;
    for (const std::uint32_t count : some.counts) {
      lists_.replace(escaped[next++], entries.first(count));
      entries = entries.subspan(count);
    }
  }
  assert(next == escaped.size());
  return true;
}

// Gives particle i a new reference path. Returns false if it reaches beyond the nearest image.
bool NeighbourLists::renew_path(std::size_t i, const Rotation& to_middle) {
  require_finite(step().particles, i);
  ++counts_.renewed;
  policy_.renewed_one();
  interval_.renewed(i);
  return references_.renew(step(), i, to_middle);
}

void NeighbourLists::rebuild_list(std::size_t i) {
  assert(i < lists_.size());
  interval_.stays(i);
  if (!renew_path(i, references_.to_middle_of_rest(step()))) {
    reaches_far_ = true;
    valid_ = false; // the next step rebuilds, and the policy learns nothing from lists made by rebuild_for_step()
    return;
  }
  std::vector<std::uint32_t> buffer;
  lists_.replace(static_cast<std::uint32_t>(i), references_.find_neighbours(step(), i, buffer, counts_.tested));
}

void NeighbourLists::mark_dirty(std::span<const std::uint32_t> particles) {
  assert(step_);
  std::uint64_t entries = 0;
  for (const std::uint32_t i : particles) {
    interval_.mark_dirty(i);
    entries += lists_.length(i);
  }
  policy_.hit(entries);
  step_.reset();
  assert(sound());
}

void NeighbourLists::release() {
  valid_ = false;
  step_.reset();
  references_.release();
  lists_.release();
  interval_.release();
}

std::size_t NeighbourLists::bytes() const {
  return references_.bytes() + lists_.bytes() + interval_.bytes();
}

// True if the invariants hold; of many particles, which would take long, unchecked.
bool NeighbourLists::sound() const {
  constexpr std::size_t max_checked = 20000;
  if (!valid_ || lists_.size() > max_checked)
    return true;
  const StepInterval &lists = references_.lifetime(), &interval = interval_.steps();
  return lists.age - interval.age + interval.length <= lists.length && references_.sound(lists_.size()) &&
         lists_.sound() && interval_.sound(lists_.size());
}

} // namespace keeler::collision
