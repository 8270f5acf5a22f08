// A cell list (Allen & Tildesley 2017, §5.3.2) of straight lines over a span of time, with the boxes that they reach.
//
// Lines stand in levels by how far they reach in the span (slack and path, in steps of 4), each level with cells of its
// own size; a line is looked up in its own level and in all finer ones, so that a moonlet or a fast particle costs what
// it reaches and nobody else anything (hierarchical cells: Iwai et al. 1999; Ogarko & Luding 2012). Cells are columns
// of a level, rows within a column, so that what a line can reach in a column is one or two ranges of slots.
//
// Invariants: each line has one slot, in the range of its cell; a line stands within its level's stray of its cell, and
// reaches no farther than its level.
#pragma once

#include "kernels.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <cmath>
#include <span>
#include <vector>

namespace keeler {

class LineCells {
public:
  /// Sorts lines in, of which each `place` says its number. They are of an instant when the box has that shear offset,
  /// and serve for `half` (rad) before and after. Levels begin at `least`, m: what the smallest reach at rest.
  void build(std::span<const Line> lines, const ShearingBox& box, double offset, double half, double least);

  /// Whether no two lines may meet through more than one image, and that one is the nearest.
  bool one_image() const { return one_image_; }
  /// The same for one more line.
  bool one_image(const Line& line) const;

  std::size_t size() const { return slots_.size(); }
  const LineFrame& frame() const { return frame_; }
  std::uint32_t place(std::size_t slot) const { return lines_[slot].place; }
  const Line& line(std::size_t place) const { return lines_[slots_[place]]; }

  /// No two lines that may touch stand farther apart across the box, as a fraction of it (2⁻³²).
  std::uint64_t farthest_across() const;

  /// A particle has a new line, which takes the slot of the old one.
  void replace(std::size_t place, const Line& line);

  /// Pairs of slots that may touch in the span, of the slots [begin, end) with all after them: found(slot, slot).
  /// Returns how many pairs were tested.
  template<class Found>
  std::uint64_t sweep_pairs(std::size_t begin, std::size_t end, const LineSpan& span, std::vector<LinePair>& buffer,
                            const Found& found) const;

  /// Slots of lines that may touch this one in the span, put into the buffer; returns how many. Adds to `tested`.
  std::size_t near(const Line& line, const LineSpan& span, std::vector<std::uint32_t>& buffer,
                   std::uint64_t& tested) const;

  void release() { *this = {}; }
  std::size_t bytes() const;

private:
  struct Level {
    std::uint64_t count = 0;
    double reach_x = 0.0, reach_y = 0.0; // the farthest of its lines, m
    double stray_x = 0.0, stray_y = 0.0; // how far they may stand from their cells, m
    std::int64_t columns = 1, rows = 1;
    std::size_t first_cell = 0;
    std::uint32_t begin = 0, end = 0; // slots
  };
  // The places that a line, or each of several, takes in a span: so many metres around one.
  struct Window {
    std::int64_t x;  // across
    std::uint32_t y; // along
    double around_x, around_y;
    double reach_x; // of the lines in the whole span
  };
  static constexpr int max_levels = 32;
  struct Measured;

  void measure(std::span<const Line> lines);
  std::size_t lay_out_cells();
  void sort(std::span<const Line> lines, std::size_t cells);
  int level_of(const Line& line) const;
  std::size_t cell_of(const Line& line, const Level& level) const;
  void assert_sorted() const; // there with assertions only
  double reach_x(const Line& line) const { return line.size + half_ * std::fabs(line.u); }
  double reach_y(const Line& line) const { return line.size + half_ * std::fabs(line.v); }
  Window window(std::size_t first, std::size_t last) const;
  Window window(const Line& line, const LineSpan& span) const;
  std::size_t group_end(std::size_t first, std::size_t end, const Level& level) const;
  template<class Range>
  void ranges_in(const Level& level, const Window& from, std::uint32_t after, const Range& range) const;
  template<class Cells>
  void rows_in(const Level& level, std::size_t cell, std::uint32_t y, std::int64_t far, const Cells& cells) const;
  static std::uint32_t across(const Line& line) {
    return static_cast<std::uint32_t>(line.x) + (std::uint32_t{1} << 31);
  }
  static std::uint32_t along(const Line& line) { return static_cast<std::uint32_t>(line.y) + (std::uint32_t{1} << 31); }
  // Where to look for those whose images stand so many boxes outward.
  std::uint32_t image_y(std::uint32_t y, int boxes) const {
    return y + static_cast<std::uint32_t>(boxes) * static_cast<std::uint32_t>(frame_.offset_y);
  }

  ShearingBox box_;
  double half_ = 0.0;
  double least_ = 1.0;
  bool one_image_ = false;
  LineFrame frame_{};
  double per_metre_x_ = 0.0, per_metre_y_ = 0.0; // box fractions, in units of 2⁻³²
  Kernels kernels_ = kernels(choose_instruction_set());

  std::vector<Level> levels_;         // the finest first; without empty ones
  int level_index_[max_levels] = {};  // of level_of()
  std::vector<std::uint32_t> starts_; // first slot of each cell
  std::vector<std::uint32_t> cells_;  // of each place
  std::vector<std::uint32_t> slots_;  // of each place
  std::vector<Line> lines_;           // by slot, and padding
};

// Slots from `after` on that lie in the level's cells within reach; of columns that end before it none.
template<class Range>
void LineCells::ranges_in(const Level& level, const Window& from, std::uint32_t after, const Range& range) const {
  if (level.end <= after)
    return;
  const auto cells = [&](std::size_t from_cell, std::size_t to_cell) {
    const std::uint32_t begin = std::max(starts_[from_cell], after), end = starts_[to_cell];
    if (begin < end)
      range(begin, end);
  };
  const double sheared = box_.shear * half_ * (from.reach_x + level.reach_x);
  const double metres_x = from.around_x + level.reach_x + level.stray_x;
  const double metres_y = from.around_y + level.reach_y + level.stray_y + sheared;
  const std::int64_t far_x = static_cast<std::int64_t>(metres_x * per_metre_x_) + 4;
  const std::int64_t far_y = static_cast<std::int64_t>(metres_y * per_metre_y_) + 4;
  const std::int64_t first = (from.x - far_x) * level.columns >> 32, last = (from.x + far_x) * level.columns >> 32;
  if (last - first >= level.columns) { // all columns, each once: images on either side
    cells(level.first_cell, level.first_cell + static_cast<std::size_t>(level.columns * level.rows));
    return;
  }
  for (std::int64_t c = first; c <= last; ++c) {
    const int boxes = c < 0 ? -1 : c >= level.columns ? 1 : 0; // outward
    const std::size_t cell = level.first_cell + static_cast<std::size_t>((c - boxes * level.columns) * level.rows);
    if (after == 0 || starts_[cell + static_cast<std::size_t>(level.rows)] > after)
      rows_in(level, cell, image_y(from.y, boxes), far_y, cells);
  }
}

// The cells of one column, the first of which is `cell`, within reach of a place along the orbit; the box is round.
template<class Cells>
void LineCells::rows_in(const Level& level, std::size_t cell, std::uint32_t y, std::int64_t far,
                        const Cells& cells) const {
  const std::int64_t rows = level.rows;
  const std::int64_t low = (std::int64_t{y} - far) * rows >> 32, high = (std::int64_t{y} + far) * rows >> 32;
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
  std::uint64_t tested = 0;
  // the slots [first, last) with the others of a range
  const auto sweep = [&](std::size_t first, std::size_t last, std::uint32_t low, std::uint32_t high) {
    const std::size_t most = (last - first) * (high - low);
    if (buffer.size() < most)
      buffer.resize(most);
    const std::size_t count = kernels_.sweep_group(lines_.data(), first, last, frame_, span, low, high, buffer.data());
    for (std::size_t k = 0; k < count; ++k)
      found(buffer[k].first, buffer[k].second);
    tested += most;
    for (std::size_t slot = first + 1; low > first && slot < last; ++slot) // behind itself only
      tested -= std::min<std::size_t>(std::max<std::size_t>(slot + 1, low), high) - low;
  };
  auto own = levels_.begin();
  for (std::size_t first = begin, last = begin; first < end; first = last) {
    while (first >= own->end)
      ++own;
    last = group_end(first, std::min<std::size_t>(end, own->end), *own);
    ranges_in(*own, window(first, last), static_cast<std::uint32_t>(first) + 1,
              [&](std::uint32_t low, std::uint32_t high) { sweep(first, last, low, high); });
    if (own == levels_.begin())
      continue;
    for (std::size_t slot = first; slot < last; ++slot) { // finer ones are much smaller than the group
      const Window from = window(slot, slot + 1);
      for (auto finer = levels_.begin(); finer != own; ++finer)
        ranges_in(*finer, from, 0, [&](std::uint32_t low, std::uint32_t high) { sweep(slot, slot + 1, low, high); });
    }
  }
  return tested;
}

} // namespace keeler
