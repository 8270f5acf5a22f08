// Looking around in a mirror: where lines may meet others, which ranges that is, and the sweeps.
#include "mirror.hpp"

#include <cmath>
#include <cstdlib>
#include <numeric>

namespace keeler {
namespace {

constexpr std::size_t most_in_group = 8;   // lines that look around together,
constexpr std::int64_t fewest_columns = 8; // for that
constexpr double longest_group = 4.0;      // in reaches of their level
constexpr std::uint32_t few_lines = 8;     // of a level: looked at all together

} // namespace

// A line's size has room for what the span has beyond the window.
Mirror::Lookout Mirror::lookout(const Line& line, const LineSpan& span) const {
  const double begin = std::max<double>(span.begin, -window_.half_length);
  const double end = std::min<double>(span.end, window_.half_length);
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const auto on = [&](float speed, double per_metre) { return static_cast<std::int64_t>(middle * speed * per_metre); };
  return {across(line) + on(line.u, per_metre_x_), along(line) + static_cast<std::uint32_t>(on(line.v, per_metre_y_)),
          line.size + half * std::fabs(line.u), line.size + half * std::fabs(line.v), reach_x(line)};
}

// Lines that follow each other and stand close together look around together: up to this slot. Not where that might be
// all around a narrow box.
std::size_t Mirror::group_end(std::size_t first, std::size_t end, const MirrorLevel& level) const {
  if (level.columns < fewest_columns)
    return first + 1;
  const auto near_x = static_cast<std::int64_t>(2.0 * level.reach_x * per_metre_x_);
  const auto near_y = static_cast<std::int64_t>(longest_group * level.reach_y * per_metre_y_);
  std::size_t last = first + 1;
  const auto stands_near = [&](const Line& line) {
    return std::abs(std::int64_t{line.x} - lines_[first].x) < near_x &&
           std::abs(std::int64_t{line.y} - lines_[first].y) < near_y;
  };
  while (last < end && last - first < most_in_group && stands_near(lines_[last]))
    ++last;
  return last;
}

// Of a group.
Mirror::Lookout Mirror::lookout(std::size_t first, std::size_t last) const {
  const Line& line = lines_[first];
  std::int64_t left = line.x, right = left, back = line.y, front = back;
  double reach[2] = {reach_x(line), reach_y(line)};
  for (std::size_t k = first + 1; k < last; ++k) {
    const Line& other = lines_[k];
    left = std::min<std::int64_t>(left, other.x);
    right = std::max<std::int64_t>(right, other.x);
    back = std::min<std::int64_t>(back, other.y);
    front = std::max<std::int64_t>(front, other.y);
    reach[0] = std::max(reach[0], reach_x(other));
    reach[1] = std::max(reach[1], reach_y(other));
  }
  constexpr std::int64_t half_turn = std::int64_t{1} << 31;
  const double half_x = 0.5 * static_cast<double>(right - left) + 1.0,
               half_y = 0.5 * static_cast<double>(front - back) + 1.0;
  return {(left + right) / 2 + half_turn, static_cast<std::uint32_t>((back + front) / 2 + half_turn),
          reach[0] + half_x / per_metre_x_, reach[1] + half_y / per_metre_y_, reach[0]};
}

std::size_t Mirror::near(const MirrorPart& part, const Line& line, const LineSpan& span,
                         std::vector<std::uint32_t>& buffer) const {
  std::size_t count = 0;
  const Lookout from = lookout(line, span);
  const auto take = [&](std::uint32_t begin, std::uint32_t end) {
    const std::size_t room = count + (end - begin) + sweep_padding;
    if (buffer.size() < room)
      buffer.resize(2 * room);
    std::iota(buffer.data() + count, buffer.data() + count + (end - begin), begin);
    count += end - begin;
  };
  for (const MirrorLevel& level : part.levels)
    if (part.whole() && level.end - level.begin <= few_lines) // to find those in reach would take longer
      take(level.begin, level.end);
    else
      ranges_in(level, from, 0, take);
  if (has_guests())
    cells_in(guests_.tiles, from, 0, [&](std::size_t from_tile, std::size_t to_tile) {
      for (std::size_t tile = from_tile; tile < to_tile; ++tile)
        for (std::uint32_t g = guests_.last[tile]; g > 0; g = guests_.before[g - 1])
          take(static_cast<std::uint32_t>(size()) + g - 1, static_cast<std::uint32_t>(size()) + g);
    });
  return sweeps_.one(line, lines_.data(), frame_, span, buffer.data(), count);
}

void Mirror::prefetch(std::size_t place, int stage) const {
  if (stage == 0) {
    __builtin_prefetch(&slots_[place]);
    __builtin_prefetch(&cells_[place]);
    __builtin_prefetch(&unsorted_[place].place, 1);
    return;
  }
  const std::size_t cell = cells_[place];
  const auto rows = static_cast<std::size_t>(level_at(whole_.levels, cell).rows);
  for (const std::size_t column : {cell - rows, cell, cell + rows}) { // the first may wrap around
    const std::size_t near = std::min(column, starts_.size() - 1);
    if (stage == 1)
      __builtin_prefetch(&starts_[near]);
    else
      for (std::size_t k = 0; k < 6; k += 2) // from the row before on
        __builtin_prefetch(&lines_[std::min(std::max<std::size_t>(starts_[near], 2) - 2 + k, lines_.size() - 1)]);
  }
}

} // namespace keeler
