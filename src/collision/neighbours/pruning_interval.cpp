#include "pruning_interval.hpp"

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
  assert(lines_.size() == count + kernel_padding);
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

std::uint64_t PruningInterval::prune(const ListedPairs& pairs, const VerletList& list, double step) {
  assert(steps_.age == 0);
  dirty_.reset(list.size());
  escaped_.clear();
  escapes_later_.assign(list.size(), 0);
  pruned_.resize(pairs.blocks());
  const double half = steps_.half(step);
  const LineSpan all = widened(-half, half, half);
  std::vector<std::uint64_t> tested(pruned_.size());
  parallel_for(
      pruned_.size(),
      [&](std::size_t b) {
        pairs.visit_block(b, list, [&](const PaddedPairs& listed) {
          const std::size_t count = pair_count(listed);
          PaddedPairs kept(count);
          auto end = kept.begin() + static_cast<std::ptrdiff_t>(filter(all, listed.data(), count, kept.data()));
          if (pairs.from_rebuild(b))
            end = std::remove_if(kept.begin(), end, [&](const LinePair& pair) { return pairs.superseded(pair); });
          pruned_[b].assign(kept.begin(), end);
          pruned_[b].resize(pruned_[b].size() + kernel_padding);
          tested[b] = count;
        });
      },
      1);
  return std::accumulate(tested.begin(), tested.end(), std::uint64_t{0});
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
  lines_ = {};
  pruned_ = {};
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
