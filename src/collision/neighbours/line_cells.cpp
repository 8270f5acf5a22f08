#include "line_cells.hpp"

#include "ablation.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/parallel.hpp>

#include <array>
#include <cassert>
#include <cstdlib>
#include <numeric>

namespace keeler::collision {
namespace {

constexpr std::size_t lines_per_block = 4096;
constexpr double nearest_fraction = 0.45;  // of the box: up to that reach, only the nearest image can touch
constexpr double cells_per_particle = 2.0; // at most, of a level,
constexpr double min_cells = 64.0;         // unless these are more
constexpr std::size_t max_in_group = 8;    // lines that look up the cells in reach together,
constexpr std::int64_t min_columns = 8;    // in levels with at least so many columns
constexpr double max_group_length = 4.0;   // in reaches of their level
constexpr std::uint32_t few_lines = 8;     // of a level: all are tested

} // namespace

struct LineCells::Measured {
  std::array<std::uint64_t, max_levels> counts{};
  std::array<double, max_levels> reach_x{}, reach_y{};
};

// Level 0: a reach below 2 of the smallest; then below 8, 32, … Each level in use costs every search a look-up.
int LineCells::level_of(const Line& line) const {
  const double reach = std::max(reach_x(line), reach_y(line));
  return reach < 2.0 * min_reach_ || without(Acceleration::levels)
             ? 0
             : (std::min(std::ilogb(reach / min_reach_), 2 * max_levels - 3) + 1) / 2;
}

std::size_t LineCells::cell_of(const Line& line, const Level& level) const {
  const auto part = [](std::uint32_t folded, std::int64_t parts) { return std::int64_t{folded} * parts >> 32; };
  return level.first_cell + static_cast<std::size_t>(part(across(line) * folds_.x, level.columns) * level.rows +
                                                     part(along(line) * folds_.y, level.rows));
}

void LineCells::build(std::span<const Line> lines, const ShearingBox& box, double offset, double half, double min_reach,
                      const cells::Folds& folds) {
  assert(half > 0.0 && (lines.empty() || min_reach > 0.0));
  box_ = box;
  folds_ = folds;
  half_ = half;
  min_reach_ = min_reach;
  per_metre_x_ = full_turn / box.size_x;
  per_metre_y_ = full_turn / box.size_y;
  frame_ = {static_cast<float>(box.size_x / full_turn), static_cast<float>(box.size_y / full_turn),
            static_cast<float>(box.shear),
            static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llrint(offset * per_metre_y_)))};
  measure(lines);
  sort(lines, lay_out_cells());
}

// Finds the levels in use and the largest reach of each.
void LineCells::measure(std::span<const Line> lines) {
  const std::size_t count = lines.size();
  std::vector<Measured> measured((count + lines_per_block - 1) / lines_per_block);
  parallel_for(
      measured.size(),
      [&](std::size_t b) {
        Measured& m = measured[b];
        for (std::size_t k = b * lines_per_block; k < std::min(count, (b + 1) * lines_per_block); ++k) {
          const int level = level_of(lines[k]);
          ++m.counts[level];
          m.reach_x[level] = std::max(m.reach_x[level], reach_x(lines[k]));
          m.reach_y[level] = std::max(m.reach_y[level], reach_y(lines[k]));
        }
      },
      1);
  levels_.clear();
  for (int l = 0; l < max_levels; ++l) {
    Level all;
    for (const Measured& m : measured) {
      all.count += m.counts[l];
      all.reach_x = std::max(all.reach_x, m.reach_x[l]);
      all.reach_y = std::max(all.reach_y, m.reach_y[l]);
    }
    level_index_[l] = static_cast<int>(levels_.size());
    if (all.count)
      levels_.push_back(all);
  }
}

// Chooses columns as wide as two lines of the level reach together and rows of half of that, so that ranges end close
// to the reach. Cells are larger where they would be too many, and longer where lines are few. Returns the number of
// cells.
std::size_t LineCells::lay_out_cells() {
  std::size_t cells = 0;
  double two_farthest[2] = {0.0, 0.0};
  for (Level& level : levels_) {
    const double max_cells = std::max(cells_per_particle * static_cast<double>(level.count), min_cells);
    double columns = box_.size_x / folds_.x / (2.0 * level.reach_x), rows = box_.size_y / folds_.y / level.reach_y;
    columns = std::min(columns, std::max(min_cells, columns / std::sqrt(std::max(1.0, columns * rows / max_cells))));
    level.columns = static_cast<std::int64_t>(std::max(1.0, columns));
    level.rows =
        static_cast<std::int64_t>(std::max(1.0, std::min(rows, max_cells / static_cast<double>(level.columns))));
    level.first_cell = cells;
    cells += static_cast<std::size_t>(level.columns * level.rows);
    const double reach = std::max(level.reach_x, level.reach_y);
    two_farthest[0] = level.count > 1 ? reach : two_farthest[1];
    two_farthest[1] = reach;
  }
  const double sheared = 1.0 + box_.shear * half_;
  one_image_ = (two_farthest[0] + two_farthest[1]) * sheared < nearest_fraction * std::min(box_.size_x, box_.size_y);
  return cells;
}

bool LineCells::one_image(const Line& line) const {
  const double reach = std::max(reach_x(line), reach_y(line));
  const double farthest = levels_.empty() ? 0.0 : std::max(levels_.back().reach_x, levels_.back().reach_y);
  const double sheared = 1.0 + box_.shear * half_;
  return (reach + std::max(reach, farthest)) * sheared < nearest_fraction * std::min(box_.size_x, box_.size_y);
}

BoxDistance LineCells::farthest_neighbour() const {
  double x = 0.0, y = 0.0;
  for (const Level& level : levels_) {
    x = std::max(x, level.reach_x);
    y = std::max(y, level.reach_y + box_.shear * half_ * level.reach_x);
  }
  constexpr double two = 2.0 + 2e-5; // lines are tested in single precision
  return {static_cast<std::uint64_t>(two * x * per_metre_x_) + 4,
          static_cast<std::uint64_t>(two * y * per_metre_y_) + 4};
}

void LineCells::sort(std::span<const Line> lines, std::size_t cells) {
  const std::size_t count = lines.size();
  cells_.resize(count);
  slots_.resize(count);
  lines_.resize(count + kernel_padding);
  parallel_for(
      count,
      [&](std::size_t k) {
        cells_[k] = static_cast<std::uint32_t>(cell_of(lines[k], levels_[level_index_[level_of(lines[k])]]));
      },
      lines_per_block);
  counting_sort(cells_, cells, starts_, [&](std::size_t k, std::size_t slot) {
    slots_[k] = static_cast<std::uint32_t>(slot);
    lines_[slot] = lines[k];
  });
  for (Level& level : levels_) {
    level.begin = starts_[level.first_cell];
    level.end = starts_[level.first_cell + static_cast<std::size_t>(level.columns * level.rows)];
  }
  assert(sound());
}

bool LineCells::sound() const {
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const Line& own = line(k);
    if (own.tag != k || slots_[k] < starts_[cells_[k]] || slots_[k] >= starts_[cells_[k] + 1])
      return false;
    const Level& level = levels_[level_of_cell(cells_[k])];
    const Distance stray = distance(own, cells_[k], level);
    const double rounding_x = 1.0 / per_metre_x_, rounding_y = 1.0 / per_metre_y_;
    if (stray.x > level.stray_x + rounding_x || stray.y > level.stray_y + rounding_y || reach_x(own) > level.reach_x ||
        reach_y(own) > level.reach_y)
      return false;
  }
  return true;
}

std::size_t LineCells::level_of_cell(std::size_t cell) const {
  std::size_t level = 0;
  while (level + 1 < levels_.size() && cell >= levels_[level + 1].first_cell)
    ++level;
  return level;
}

// Returns how far a line's position is outside the nearest copy of a cell of the level; the box is periodic.
LineCells::Distance LineCells::distance(const Line& line, std::size_t cell, const Level& level) const {
  const auto number = static_cast<std::int64_t>(cell - level.first_cell);
  // the nearest copy of the cell across, of all in the periodic box
  const std::int64_t all = level.columns * folds_.x, here = std::int64_t{across(line)} * all >> 32;
  std::int64_t off = (number / level.rows - here) % level.columns;
  off += off > level.columns / 2 ? -level.columns : off < -(level.columns / 2) ? level.columns : 0;
  const auto beyond = [](double from_middle, std::int64_t cells) {
    return std::max(0.0, std::fabs(from_middle) - 0.5 * full_turn / static_cast<double>(cells));
  };
  const auto middle = [](std::int64_t index, std::int64_t cells) {
    return (static_cast<double>(index) + 0.5) * full_turn / static_cast<double>(cells);
  };
  const std::int64_t outward = here + off < 0 ? -1 : here + off >= all ? 1 : 0;
  const std::uint32_t y = image_y(along(line), static_cast<int>(outward)) * folds_.y;
  const double off_y = static_cast<double>(y) - middle(number % level.rows, level.rows);
  return {beyond(static_cast<double>(across(line)) - middle(here + off, all), all) / per_metre_x_,
          beyond(off_y - full_turn * std::rint(off_y / full_turn), level.rows) / (per_metre_y_ * folds_.y)};
}

void LineCells::replace(std::size_t particle, const Line& line) {
  assert(particle < slots_.size());
  Level& level = levels_[level_of_cell(cells_[particle])];
  const Distance stray = distance(line, cells_[particle], level);
  level.stray_x = std::max(level.stray_x, stray.x);
  level.stray_y = std::max(level.stray_y, stray.y);
  level.reach_x = std::max(level.reach_x, reach_x(line));
  level.reach_y = std::max(level.reach_y, reach_y(line));
  lines_[slots_[particle]] = line;
  lines_[slots_[particle]].tag = static_cast<std::uint32_t>(particle);
}

LineCells::Rectangle LineCells::rectangle(const Line& line, const LineSpan& span) const {
  const double begin = std::max<double>(span.begin, -half_), end = std::min<double>(span.end, half_);
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin); // the size allows for the rest of the span
  const auto on = [&](float speed, double per_metre) { return static_cast<std::int64_t>(middle * speed * per_metre); };
  return {across(line) + on(line.u, per_metre_x_), along(line) + static_cast<std::uint32_t>(on(line.v, per_metre_y_)),
          line.size + half * std::fabs(line.u), line.size + half * std::fabs(line.v), reach_x(line)};
}

// Returns the end of the group that begins with the slot `first`: lines behind each other and close together. Groups
// have one line in a narrow box, which they might surround.
std::size_t LineCells::group_end(std::size_t first, std::size_t end, const Level& level) const {
  if (level.columns < min_columns || without(Acceleration::groups))
    return first + 1;
  const auto near_x = static_cast<std::int64_t>(2.0 * level.reach_x * per_metre_x_);
  const auto near_y = static_cast<std::int64_t>(max_group_length * level.reach_y * per_metre_y_);
  std::size_t last = first + 1;
  const auto is_near = [&](const Line& line) {
    return std::abs(std::int64_t{line.x} - lines_[first].x) < near_x &&
           std::abs(std::int64_t{line.y} - lines_[first].y) < near_y;
  };
  while (last < end && last - first < max_in_group && is_near(lines_[last]))
    ++last;
  return last;
}

// Returns the rectangle of a group of slots.
LineCells::Rectangle LineCells::rectangle(std::size_t first, std::size_t last) const {
  assert(first < last && last <= size());
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

std::size_t LineCells::find_near(const Line& line, const LineSpan& span, std::vector<std::uint32_t>& buffer,
                                 std::uint64_t& tested) const {
  std::size_t count = 0;
  const Rectangle around = rectangle(line, span);
  const auto take = [&](std::uint32_t begin, std::uint32_t end) {
    const std::size_t room = count + (end - begin) + kernel_padding;
    if (buffer.size() < room)
      buffer.resize(2 * room);
    std::iota(buffer.data() + count, buffer.data() + count + (end - begin), begin);
    count += end - begin;
  };
  for (const Level& level : levels_)
    if (level.end - level.begin <= few_lines) // finding the cells in reach would take longer
      take(level.begin, level.end);
    else
      ranges_in(level, around, 0, take);
  if (count == 0)
    return 0;
  std::fill_n(buffer.begin() + static_cast<std::ptrdiff_t>(count), kernel_padding, buffer[count - 1]);
  tested += count;
  return kernels_.sweep(line, lines_.data(), frame_, span, buffer.data(), count, buffer.data());
}

std::size_t LineCells::bytes() const {
  return (starts_.capacity() + cells_.capacity() + slots_.capacity()) * sizeof(std::uint32_t) +
         lines_.capacity() * sizeof(Line);
}

} // namespace keeler::collision
