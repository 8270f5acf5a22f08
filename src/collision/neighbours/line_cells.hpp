// A cell list (Allen & Tildesley 2017, §5.3.2) of straight lines over a span of time.
//
// Cells are hierarchical (Iwai et al. 1999; Ogarko & Luding 2012): a line's level is how far it reaches in the span
// (size and path, in steps of a factor 4), and each level has cells of a suitable size. A search of pairs tests a line
// against its level and all finer ones, so a moonlet or a fast particle costs what it reaches, and the other lines next
// to nothing. Cells are columns of a level and rows within a column, so the cells of a column in reach of a line are
// one or two ranges of slots.
//
// Invariants: each line has one slot, in the range of its cell; its position is within its level's `stray` of its cell,
// and its reach is at most its level's.
#pragma once

#include "kernels.hpp"

#include <keeler/cells/folds.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

namespace keeler::collision {

class LineCells {
public:
  /// Sorts lines into cells. Their instant is when the box has the shear offset `offset` (m), and they are valid for
  /// `half` (rad) before and after. `min_reach` (m): reach of the smallest particle at rest, where levels begin.
  /// `folds` saves cells if the lines are in a part of the box only. Precondition: lines[k].tag == k.
  void build(std::span<const Line> lines, const ShearingBox& box, double offset, double half, double min_reach,
             const cells::Folds& folds = {});

  /// True if no two lines can meet through another image than the nearest one.
  bool one_image() const { return one_image_; }
  /// True if `line` cannot meet the others through another image than the nearest one.
  bool one_image(const Line& line) const;

  std::size_t size() const { return slots_.size(); }
  const LineFrame& frame() const { return frame_; }
  std::uint32_t particle(std::size_t slot) const { return lines_[slot].tag; }
  const Line& line(std::size_t particle) const { return lines_[slots_[particle]]; }

  /// Upper bound on the distance of two lines that may touch, at their instant.
  BoxDistance farthest_neighbour() const;

  /// Replaces the line of a particle, which keeps its slot.
  void replace(std::size_t particle, const Line& line);

  /// Calls found(slot, slot) for each pair of lines that may touch during the span, the first in the slots [begin, end)
  /// and the second in the same level behind it, or in a finer level. Returns the number of pairs tested.
  template<class Found>
  std::uint64_t sweep_pairs(std::size_t begin, std::size_t end, const LineSpan& span, std::vector<LinePair>& buffer,
                            const Found& found) const;

  /// Writes the slots of the lines that may touch `line` during the span to `buffer`, which grows as needed. Returns
  /// their number, and adds the number of lines tested to `tested`.
  std::size_t find_near(const Line& line, const LineSpan& span, std::vector<std::uint32_t>& buffer,
                        std::uint64_t& tested) const;

  void release() { *this = {}; }
  std::size_t bytes() const;

  /// True if the invariants hold.
  bool sound() const;

private:
  struct Level {
    std::uint64_t count = 0;
    double reach_x = 0.0, reach_y = 0.0; // largest of its lines, m
    double stray_x = 0.0, stray_y = 0.0; // largest distance of a line's position from its cell, m
    std::int64_t columns = 1, rows = 1;  // of one copy of the folded box
    std::size_t first_cell = 0;
    std::uint32_t begin = 0, end = 0; // slots
  };
  // A rectangle that contains a line, or each of several, during a span.
  struct Rectangle {
    std::int64_t x;        // centre, across
    std::uint32_t y;       // and along the box
    double half_x, half_y; // m
    double reach_x;        // of the lines in all the time that the cells are valid
  };
  struct Distance {
    double x, y; // m
  };
  static constexpr int max_levels = 32;
  struct Measured;

  void measure(std::span<const Line> lines);
  std::size_t lay_out_cells();
  void sort(std::span<const Line> lines, std::size_t cells);
  int level_of(const Line& line) const;
  std::size_t cell_of(const Line& line, const Level& level) const;
  std::size_t level_of_cell(std::size_t cell) const;
  Distance distance(const Line& line, std::size_t cell, const Level& level) const;
  double reach_x(const Line& line) const { return line.size + half_ * std::fabs(line.u); }
  double reach_y(const Line& line) const { return line.size + half_ * std::fabs(line.v); }
  Rectangle rectangle(std::size_t first, std::size_t last) const;
  Rectangle rectangle(const Line& line, const LineSpan& span) const;
  std::size_t group_end(std::size_t first, std::size_t end, const Level& level) const;
  template<class Range>
  void ranges_in(const Level& level, const Rectangle& around, std::uint32_t after, const Range& range) const;
  template<class Cells>
  void rows_in(const Level& level, std::size_t cell, std::uint32_t y, std::int64_t far, const Cells& cells) const;
  static std::uint32_t across(const Line& line) {
    return static_cast<std::uint32_t>(line.x) + (std::uint32_t{1} << 31);
  }
  static std::uint32_t along(const Line& line) { return static_cast<std::uint32_t>(line.y) + (std::uint32_t{1} << 31); }
  // Returns the position along the box of lines that have their images `boxes` boxes outward at y.
  std::uint32_t image_y(std::uint32_t y, int boxes) const {
    return y + static_cast<std::uint32_t>(boxes) * static_cast<std::uint32_t>(frame_.offset_y);
  }

  ShearingBox box_;
  cells::Folds folds_;
  double half_ = 0.0;
  double min_reach_ = 1.0; // m
  bool one_image_ = false;
  LineFrame frame_{};
  double per_metre_x_ = 0.0, per_metre_y_ = 0.0; // box fractions, in units of 2⁻³²
  Kernels kernels_ = kernels(choose_instruction_set());

  std::vector<Level> levels_;         // finest first, without empty ones
  int level_index_[max_levels] = {};  // in levels_, by level_of()
  std::vector<std::uint32_t> starts_; // first slot of each cell
  std::vector<std::uint32_t> cells_;  // by particle
  std::vector<std::uint32_t> slots_;  // by particle
  std::vector<Line> lines_;           // by slot, with padding behind
};

// Calls range(begin, end) for the slots, from `after` on, of the level's cells in reach of the rectangle.
template<class Range>
void LineCells::ranges_in(const Level& level, const Rectangle& around, std::uint32_t after, const Range& range) const {
  if (level.end <= after)
    return;
  const auto cells = [&](std::size_t from_cell, std::size_t to_cell) {
    const std::uint32_t begin = std::max(starts_[from_cell], after), end = starts_[to_cell];
    if (begin < end)
      range(begin, end);
  };
  const double sheared = box_.shear * half_ * (around.reach_x + level.reach_x);
  const double metres_x = around.half_x + level.reach_x + level.stray_x;
  const double metres_y = around.half_y + level.reach_y + level.stray_y + sheared;
  const std::int64_t far_x = static_cast<std::int64_t>(metres_x * per_metre_x_) + 4;
  const std::int64_t far_y = static_cast<std::int64_t>(metres_y * per_metre_y_) + 4;
  const std::int64_t all = level.columns * folds_.x; // of the box
  const std::int64_t first = (around.x - far_x) * all >> 32, last = (around.x + far_x) * all >> 32;
  if (last - first >= level.columns) { // all columns, each once
    cells(level.first_cell, level.first_cell + static_cast<std::size_t>(level.columns * level.rows));
    return;
  }
  for (std::int64_t c = first; c <= last; ++c) {
    const int boxes = c < 0 ? -1 : c >= all ? 1 : 0; // outward
    const std::int64_t column = folds_.x == 1 ? c - boxes * all : (c - boxes * all) % level.columns;
    const std::size_t cell = level.first_cell + static_cast<std::size_t>(column * level.rows);
    if (after == 0 || starts_[cell + static_cast<std::size_t>(level.rows)] > after)
      rows_in(level, cell, image_y(around.y, boxes), far_y, cells);
  }
}

// Calls cells(first, last) for the cells of one column, which begins with `cell`, within `far` of y in the periodic,
// folded box.
template<class Cells>
void LineCells::rows_in(const Level& level, std::size_t cell, std::uint32_t y, std::int64_t far,
                        const Cells& cells) const {
  const std::int64_t rows = level.rows, folded_y = y * folds_.y; // modulo 2³²
  const std::int64_t folded_far = far * folds_.y;
  const std::int64_t low = (folded_y - folded_far) * rows >> 32, high = (folded_y + folded_far) * rows >> 32;
  const auto of_column = [&](std::int64_t from, std::int64_t to) {
    cells(cell + static_cast<std::size_t>(from), cell + static_cast<std::size_t>(to));
  };
  if (high - low + 1 >= rows) {
    of_column(0, rows);
  } else if (low < 0) {
    of_column(0, high + 1);
    of_column(low + rows, rows);
  } else if (high >= rows) {
    of_column(0, high - rows + 1);
    of_column(low, rows);
  } else {
    of_column(low, high + 1);
  }
}

template<class Found>
std::uint64_t LineCells::sweep_pairs(std::size_t begin, std::size_t end, const LineSpan& span,
                                     std::vector<LinePair>& buffer, const Found& found) const {
  assert(begin <= end && end <= size());
  std::uint64_t tested = 0;
  // tests the slots [first, last) against a range
  const auto sweep = [&](std::size_t first, std::size_t last, std::uint32_t low, std::uint32_t high) {
    const std::size_t all = (last - first) * (high - low);
    if (buffer.size() < all)
      buffer.resize(all);
    const std::size_t count = kernels_.sweep_group(lines_.data(), first, last, frame_, span, low, high, buffer.data());
    for (std::size_t k = 0; k < count; ++k)
      found(buffer[k].first, buffer[k].second);
    tested += all;
    for (std::size_t slot = first + 1; low > first && slot < last;
         ++slot) // a line is tested against the lines behind it only
      tested -= std::min<std::size_t>(std::max<std::size_t>(slot + 1, low), high) - low;
  };
  auto level = levels_.begin();
  for (std::size_t first = begin, last = begin; first < end; first = last) {
    while (first >= level->end)
      ++level;
    last = group_end(first, std::min<std::size_t>(end, level->end), *level);
    ranges_in(*level, rectangle(first, last), static_cast<std::uint32_t>(first) + 1,
              [&](std::uint32_t low, std::uint32_t high) { sweep(first, last, low, high); });
    if (level == levels_.begin())
      continue;
    for (std::size_t slot = first; slot < last; ++slot) { // finer lines are much smaller than the group
      const Rectangle around = rectangle(slot, slot + 1);
      for (auto finer = levels_.begin(); finer != level; ++finer)
        ranges_in(*finer, around, 0, [&](std::uint32_t low, std::uint32_t high) { sweep(slot, slot + 1, low, high); });
    }
  }
  return tested;
}

} // namespace keeler::collision
