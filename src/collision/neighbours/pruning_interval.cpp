#include "pruning_interval.hpp"

#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::collision {

void PruningInterval::look_ahead(const SearchContext& step) {
  middle_ = step.instant(-steps_.since_middle(step.step));
  to_middle_ = Rotation(step.frequencies, middle_.after);
}

std::vector<std::uint32_t> PruningInterval::begin(const SearchContext& step, int length,
                                                  const ReferencePaths& references) {
  assert(0 < length && length <= references.lifetime().rest());
  steps_ = {0, length};
  look_ahead(step);
  follow_ = follow_frame(step, to_middle_, middle_, references.lifetime().since_middle(step.step) + to_middle_.after,
                         steps_.half(step.step));
  frame_ = line_frame(step.box, middle_);
  constexpr std::size_t chunk = 4096;
  const std::size_t count = step.particles.size();
  lines_.resize(count + kernel_padding);
  std::vector<std::vector<std::uint32_t>> found((count + chunk - 1) / chunk);
  parallel_for(
      found.size(),
      [&](std::size_t b) {
        std::uint32_t buffer[chunk];
        const std::size_t first = b * chunk, last = std::min(count, first + chunk);
        const double* const rows = &step.particles.bodies[0].elements.guiding_x;
        const std::size_t some = kernels_.follow(rows, references.lines(), follow_, first, last, lines_.data(), buffer);
        found[b].assign(buffer, buffer + some);
      },
      1);
  std::vector<std::uint32_t> escaped;
  for (const std::vector<std::uint32_t>& some : found)
    escaped.insert(escaped.end(), some.begin(), some.end());
  return escaped;
}

std::uint64_t PruningInterval::prune(const VerletList& list, double step) {
  assert(steps_.age == 0);
  dirty_.reset(list.size());
  escaped_.clear();
  escapes_later_.assign(list.size(), 0);
  constexpr std::size_t block = 512;
  pruned_.resize((list.size() + block - 1) / block);
  std::vector<std::uint64_t> tested(pruned_.size());
  parallel_for(
      pruned_.size(),
      [&](std::size_t b) {
        std::vector<LinePair> kept;
        tested[b] = prune_lists(list, b * block, std::min(list.size(), (b + 1) * block), step, kept);
        kept.resize(kept.size() + kernel_padding);
        pruned_[b].assign(kept.begin(), kept.end());
      },
      1);
  return std::accumulate(tested.begin(), tested.end(), std::uint64_t{0});
}

// Appends the pairs of [first, last) with larger indices on their lists that may touch in the interval. Returns the
// number of pairs tested.
std::uint64_t PruningInterval::prune_lists(const VerletList& list, std::size_t first, std::size_t last, double step,
                                           std::vector<LinePair>& kept) const {
  const double half = steps_.half(step);
  const LineSpan all = widened(-half, half, half);
  constexpr std::size_t chunk = 512;
  LinePair listed[chunk + kernel_padding] = {}, some[chunk];
  std::uint64_t tested = 0;
  std::size_t count = 0;
  const auto test = [&] {
    const std::size_t left = filter(all, listed, count, some);
    kept.insert(kept.end(), some, some + left);
    tested += count;
    count = 0;
  };
  for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
    const std::uint32_t* const later = list.list(std::min<std::size_t>(i + 12, last - 1)).data();
    __builtin_prefetch(later);
    __builtin_prefetch(later + 16);
    for (const std::uint32_t j : list.list(i)) {
      listed[count] = {i, j};
      count += i < j;
      if (count == chunk)
        test();
    }
  }
  test();
  return tested;
}

bool PruningInterval::follow_hit(const SearchContext& step, std::size_t i, double time, const Line& reference) {
  assert(i < escapes_later_.size());
  const double half = steps_.half(step.step);
  Line& line = lines_[i];
  line = tangent_line(step, step.particles.bodies[i], to_middle_, 0.0, half, middle_);
  line.size += rounding_of(line, half, step.box);
  const PathOffset off = offset_from(reference, line, follow_, frame_);
  const double limit = reference.size - line.size - rounding_of(line, half, step.box);
  const auto within = [&](double when) { return limit >= 0.0 && off.at(when).squaredNorm() <= limit * limit; };
  const double now = steps_.since_middle(step.step);
  escapes_later_[i] = !within(half);
  return within(now + time) && (!escapes_later_[i] || within(now + 0.5 * step.step));
}

void PruningInterval::release() {
  free_memory(lines_);
  free_memory(pruned_);
}

std::size_t PruningInterval::bytes() const {
  std::size_t total = lines_.capacity() * sizeof(Line) + dirty_.bytes() + escaped_.capacity() * sizeof(std::uint32_t) +
                      escapes_later_.capacity() + pruned_.capacity() * sizeof(PaddedPairs);
  for (const PaddedPairs& pairs : pruned_)
    total += pairs.capacity() * sizeof(LinePair);
  return total;
}

bool PruningInterval::sound(std::size_t particles) const {
  return 0 <= steps_.age && !steps_.over() && dirty_.sound(particles) && escapes_later_.size() == particles &&
         std::all_of(escaped_.begin(), escaped_.end(), [&](std::uint32_t i) { return i < particles; });
}

} // namespace keeler::collision
