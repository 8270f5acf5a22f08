// When lists and windows begin, what is near in a window, and how lists are mended.
#include "neighbour_lists.hpp"

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace keeler {
namespace {

template<class T> std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

} // namespace

bool NeighbourLists::begin(const Particles& particles, const ShearingBox& box, double offset, bool undisturbed) {
  undisturbed = undisturbed && !without(Acceleration::windows);
  ++age_;
  const bool lived = std::exchange(made_, false); // until nothing can throw any more
  const bool serve = lived && serves(particles, box, offset);
  if (!undisturbed)
    last_run_ = std::exchange(run_, -1) + 1;
  ++run_;
  ++window_age_;
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  reaches_far_ = false;
  const double half = 0.5 * step_;
  test_ = {frequencies_, half, half, 1e-13 * (box.size_x + box.size_y)};
  bool serves_on = false;
  if (serve) {
    look_to_window();
    serves_on = undisturbed && window_age_ < window_ ? mend(leaving_) : begin_window();
  }
  made_ = serves_on || build(lived);
  leaving_.clear();
  assert((assert_sound(), true));
  return made_;
}

// Whether the lists of before are of these particles, as far as can be told without a look at them.
bool NeighbourLists::serves(const Particles& particles, const ShearingBox& box, double offset) const {
  if (age_ >= life_ || particles.size() != ranges_.size() || box.size_x != box_.size_x || box.size_y != box_.size_y ||
      box.shear != box_.shear)
    return false;
  const double moved = (offset - offset_ - box.shear * box.size_x * step_) / box.size_y;
  return std::fabs(moved - std::rint(moved)) < 1e-9;
}

// By what the last life cost a step: on in the same direction as long as that helps.
void NeighbourLists::choose_life(bool lived) {
  constexpr double longest = 1.0; // rad: bounds and rounding are good for that long
  constexpr int most = 64;
  if (lived && age_ > 0) {
    const double cost = cost_ / age_;
    if (last_cost_ > 0.0 && cost > last_cost_)
      change_of_life_ = change_of_life_ > 1.0 ? 0.8 : 1.25;
    last_cost_ = cost;
    const int next = static_cast<int>(std::lround(change_of_life_ * std::min(age_, life_)));
    next_life_ = std::max(1, change_of_life_ > 1.0 ? std::max(next, age_ + 1) : next);
  }
  next_life_ = std::clamp(static_cast<int>(longest / step_), 1, std::min(most, next_life_));
}

bool NeighbourLists::build(bool lived) {
  choose_life(lived);
  if (without(Acceleration::lists))
    next_life_ = 1;
  while (!make_cells(next_life_) && next_life_ > 1)
    next_life_ /= 2;
  return fill_lists();
}

// References for so many steps from now on. Returns whether nearest images will do for these.
bool NeighbourLists::make_cells(int life) {
  life_ = life;
  age_ = 0;
  make_references();
  cells_.build(std::span(lines_).first(particles_->size()), box_, instant(-since_middle()).offset, half_life(),
               min_radius_ + slack_);
  return cells_.one_image();
}

bool NeighbourLists::fill_lists() {
  ++built;
  if (!cells_.one_image())
    return false;
  find_pairs();
  return begin_window();
}

void NeighbourLists::make_for_step() {
  make_cells(1);
  reaches_far_ = !fill_lists();
}

// All lines, who leaves, and what is near. False: see mend().
bool NeighbourLists::begin_window() {
  constexpr double longest = 0.2; // rad: paths are still nearly straight
  constexpr int most = 8;
  constexpr double most_touched = 0.1; // of all particles: their whole lists are gone through in each later step
  const double hit_steps = static_cast<double>(touched_.size()) + 1e-3,
               particle_steps = static_cast<double>(ranges_.size()) * std::max(1, window_age_);
  const int to_disturbance = last_run_ > run_ ? last_run_ - run_ : most;
  const int longest_steps = std::clamp(static_cast<int>(longest / step_), 1, most);
  const int calm = static_cast<int>(std::min<double>(most, most_touched * particle_steps / hit_steps));
  set_window(std::clamp(std::min({longest_steps, to_disturbance, life_ - age_, calm}), 1, most));
  std::vector<std::uint32_t> leavers;
  follow(leavers);
  if (!mend(leavers))
    return false;
  touched_.clear();
  leaving_.clear();
  is_touched_.assign(ranges_.size(), 0);
  is_leaving_.assign(ranges_.size(), 0);
  pick_near();
  return true;
}

// The pairs that may touch in the window.
void NeighbourLists::pick_near() {
  const std::size_t anew_blocks = (anew_.size() + few - 1) / few;
  near_.resize(pairs_.size() + anew_blocks);
  const LineSpan span = wider(-half_window(), half_window(), half_window());
  std::vector<std::uint64_t> gone_through(near_.size());
  parallel_for(
      near_.size(),
      [&](std::size_t b) {
        Pairs own;
        if (b >= pairs_.size()) {
          const std::size_t begin = (b - pairs_.size()) * few;
          for (std::size_t k = begin; k < std::min(anew_.size(), begin + few); ++k)
            for (const std::uint32_t j : list(anew_[k]))
              if (!is_anew_[j] || anew_[k] < j)
                own.push_back({anew_[k], j});
          own.resize(own.size() + kernel_padding);
        }
        const Pairs& pairs = b < pairs_.size() ? pairs_[b] : own;
        const std::size_t count = pairs.size() - kernel_padding;
        Pairs kept(count);
        auto end = kept.begin() + static_cast<std::ptrdiff_t>(
                                      kernels_.filter(lines_.data(), frame_, span, pairs.data(), count, kept.data()));
        if (b < pairs_.size())
          end = std::remove_if(kept.begin(), end,
                               [&](const LinePair& pair) { return is_anew_[pair.first] || is_anew_[pair.second]; });
        near_[b].assign(kept.begin(), end);
        near_[b].resize(near_[b].size() + kernel_padding);
        gone_through[b] = count;
      },
      1);
  cost_ += 2.0 * static_cast<double>(std::accumulate(gone_through.begin(), gone_through.end(), std::uint64_t{0}));
}

// New references and lists for these. False when it is cheaper to make all anew, or when one of them goes too far.
bool NeighbourLists::mend(const std::vector<std::uint32_t>& leavers) {
  constexpr std::size_t cost = 6; // of listing one anew, in those of one when all are
  if (age_ > 0 &&
      ((without(Acceleration::mending) && !leavers.empty()) || (times_anew_ + leavers.size()) * cost > ranges_.size() ||
       entries_.size() > 2 * entries_made_ + 4096))
    return false;
  cost_ += 800.0 * static_cast<double>(leavers.size());
  const Rotation to_middle = to_middle_of_rest();
  for (const std::uint32_t i : leavers)
    if (!refer_anew(i, to_middle))
      return false;
  struct Found {
    std::vector<std::uint32_t> entries, counts;
    std::uint64_t tested = 0;
  };
  constexpr std::size_t chunk = 64;
  std::vector<Found> found((leavers.size() + chunk - 1) / chunk);
  const LineSpan rest = wider(since_middle() - 0.5 * step_, half_life(), half_life());
  parallel_for(
      found.size(),
      [&](std::size_t c) {
        std::vector<std::uint32_t> buffer;
        for (std::size_t k = c * chunk; k < std::min(leavers.size(), (c + 1) * chunk); ++k) {
          const std::size_t near = cells_.near(cells_.line(leavers[k]), rest, buffer, found[c].tested);
          for (std::size_t n = 0; n < near; ++n)
            found[c].entries.push_back(cells_.place(buffer[n]));
          found[c].counts.push_back(static_cast<std::uint32_t>(near));
        }
      },
      1);
  std::size_t next = 0;
  for (const Found& some : found) {
    tested += some.tested;
    std::span<const std::uint32_t> entries = some.entries;
    for (const std::uint32_t count : some.counts) {
      replace_list(leavers[next++], entries.first(count));
      entries = entries.subspan(count);
    }
  }
  return true;
}

void NeighbourLists::mark(std::vector<std::uint32_t>& which, std::vector<std::uint8_t>& marks, std::size_t i) {
  assert(i < marks.size());
  if (!marks[i])
    which.push_back(static_cast<std::uint32_t>(i));
  marks[i] = 1;
}

void NeighbourLists::list_anew(std::size_t i) {
  is_leaving_[i] = 0;
  if (!refer_anew(i, to_middle_of_rest())) {
    reaches_far_ = true;
    made_ = false; // the next step makes its own, and those of make_for_step() teach it no life
    return;
  }
  std::vector<std::uint32_t> buffer;
  const LineSpan rest = wider(since_middle() - 0.5 * step_, half_life(), half_life());
  const std::size_t near = cells_.near(cells_.line(i), rest, buffer, tested);
  for (std::size_t n = 0; n < near; ++n)
    buffer[n] = cells_.place(buffer[n]);
  replace_list(static_cast<std::uint32_t>(i), std::span(buffer).first(near));
}

void NeighbourLists::touched(std::span<const std::uint32_t> particles) {
  std::uint64_t entries = 0;
  for (const std::uint32_t i : particles) {
    mark(touched_, is_touched_, i);
    if (is_leaving_[i])
      leaving_.push_back(i);
    is_leaving_[i] = 0;
    entries += ranges_[i].count;
  }
  cost_ += 5.0 * static_cast<double>(entries);
  assert((assert_sound(), true));
}

void NeighbourLists::prefetch(std::size_t i, int stage) const {
  if (stage == 0) {
    __builtin_prefetch(&lines_[i], 1);
    __builtin_prefetch(&references_[i]);
    __builtin_prefetch(&ranges_[i]);
    return;
  }
  const Range& range = ranges_[i];
  const std::uint32_t* const entries = entries_.data() + range.begin;
  if (stage == 1) {
    __builtin_prefetch(entries);
    __builtin_prefetch(entries + range.count);
  } else {
    for (std::uint32_t k = 0; k < std::min(range.count, 32u); ++k)
      __builtin_prefetch(&lines_[entries[k]]);
  }
}

void NeighbourLists::release() {
  made_ = false;
  cells_.release();
  lines_ = {};
  entries_ = {};
  pairs_ = {};
  near_ = {};
}

std::size_t NeighbourLists::bytes() const {
  std::size_t total =
      cells_.bytes() + bytes_of(lines_) + bytes_of(references_) + bytes_of(ranges_) + bytes_of(entries_);
  total += bytes_of(touched_) + bytes_of(is_touched_) + bytes_of(leaving_) + bytes_of(is_leaving_) + bytes_of(anew_) +
           bytes_of(is_anew_);
  for (const std::vector<Pairs>* all : {&pairs_, &near_}) {
    total += bytes_of(*all);
    for (const Pairs& pairs : *all)
      total += bytes_of(pairs);
  }
  return total;
}

} // namespace keeler
