// A copy of all particles for finding neighbours fast: the straight line of each about the middle of a window of steps,
// in single precision, 32 bytes, sorted into cells. Nothing of a result is computed from it: it only says which pairs
// cannot touch.
//
// Particles stand in levels by how far they reach in the window (radius and path, in steps of 4), each level with cells
// of its own size; a particle looks into its own level and into all finer ones, so that a moonlet or a fast particle
// costs what it reaches and nobody else anything. Cells are columns of a level, rows within a column, so that what a
// particle can reach in a column is one or two ranges of the arrays.
//
// Invariant: a line stands within its level's stray of its cell. Particles that were hit get a new line but keep their
// cell, unless that line reaches or strays farther than their level is for. Then they become guests, as long as there
// is room, in tiles of their own that everybody looks into: a few fast ones do not make everybody look farther.
#pragma once

#include "line_sweep.hpp"

#include <keeler/box/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace keeler {

/// The window, as seen from the epoch of the elements that a mirror is made of.
struct MirrorWindow {
  double middle = 0.0;      ///< rad after the epoch
  double half_length = 0.0; ///< rad
  double skin = 0.0;        ///< how far kicks may move a particle off its path, m
};

/// Means over the particles: what windows are chosen by.
struct MirrorMeans {
  double eccentricity = 0.0, radius = 0.0; ///< m
};

/// Particles of similar reach, in cells of their own. Aligned: threads have copies, in lines of cache of their own.
struct alignas(64) MirrorLevel {
  std::uint64_t count = 0;
  double reach_x = 0.0, reach_y = 0.0; ///< the farthest of its particles, m
  double stray_x = 0.0, stray_y = 0.0; ///< how far their lines may stand from their cells, m
  std::int64_t columns = 1, rows = 1;
  std::size_t first_cell = 0;
  std::uint32_t begin = 0, end = 0; ///< slots
  // in a part of the mirror:
  std::int64_t first_column = 0, last_column = 0; ///< that lie in it; those beyond the box's edge count on
  /// Their slots: from here to there, and those of the columns beyond the box's edge from the level's first to the
  /// last.
  std::uint32_t own_begin = 0, own_end = 0, own_end_beyond = 0;
};

/// A mirror from one edge to another across the box, for one thread that changes nothing outside of it.
struct MirrorPart {
  std::vector<MirrorLevel> levels; ///< the finest first; without empty ones; how far those of this part reach and stray
  double farthest = 0.0;           ///< how far any of its lines may reach beyond its cell, m
  std::uint64_t width = std::uint64_t{1} << 32; ///< as a fraction of the box, 2⁻³²

  bool whole() const { return width >> 32 != 0; }
  /// Makes room in a level for those that reach and stray so far.
  void widen(MirrorLevel& level, double reach_x, double reach_y, double stray_x, double stray_y) {
    level.reach_x = std::max(level.reach_x, reach_x);
    level.reach_y = std::max(level.reach_y, reach_y);
    level.stray_x = std::max(level.stray_x, stray_x);
    level.stray_y = std::max(level.stray_y, stray_y);
    farthest = std::max({farthest, level.reach_x + level.stray_x, level.reach_y + level.stray_y});
  }
  /// Whether a slot lies in one of its columns.
  bool holds(std::uint32_t slot) const {
    return whole() || std::any_of(levels.begin(), levels.end(), [&](const MirrorLevel& level) {
             return (slot >= level.own_begin && slot < level.own_end) ||
                    (slot >= level.begin && slot < level.own_end_beyond);
           });
  }
};

class Mirror {
public:
  /// Sorts all particles in. `offset` is the shear offset at the epoch. Throws InvariantError when elements are not
  /// finite.
  void build(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
             const MirrorWindow& window);

  /// Whether no two particles may meet through more than one image, and that one is the nearest.
  bool one_image() const { return one_image_; }
  /// The same for one more line: a particle that was hit.
  bool one_image(const Line& line, const MirrorPart& part) const;

  const MirrorMeans& means() const { return means_; }
  std::size_t size() const { return cells_.size(); }
  const LineFrame& frame() const { return frame_; }
  std::uint32_t place(std::size_t slot) const { return lines_[slot].place; }
  std::uint32_t slot(std::size_t place) const { return slots_[place]; }
  const Line& line(std::size_t place) const { return lines_[slots_[place]]; }
  /// For whoever has a number to keep for a particle until the next build: room that only a build needs.
  std::uint32_t& note(std::size_t place) { return unsorted_[place].place; }
  std::uint32_t note(std::size_t place) const { return unsorted_[place].place; }

  /// The line of a body whose elements' epoch stands `rotation.after` before the middle of the window; `offset` is the
  /// shear offset at the middle.
  Line line_of(const Body& body, const Rotation& rotation) const;

  /// All of it.
  MirrorPart& whole() { return whole_; }
  const MirrorPart& whole() const { return whole_; }
  /// What lies between two places across the box, as fractions of it (2⁻³²).
  MirrorPart part(std::uint32_t begin, std::uint64_t width) const;
  /// The whole widens its levels to those of a part.
  void join(const MirrorPart& part);
  /// Where a line stands across the box.
  static std::uint32_t across(const Line& line) {
    return static_cast<std::uint32_t>(line.x) + (std::uint32_t{1} << 31);
  }
  /// The nearest edge before a place across the box, of a column of the finest level.
  std::uint32_t column_edge(std::uint32_t across) const;
  /// Whether everything that a line may touch lies in a part.
  bool encloses(const MirrorPart& part, const Line& line) const;

  /// A particle of a part has a new line. In the whole it may become a guest.
  void replace(MirrorPart& part, std::size_t place, const Line& line);
  /// Whether there are guests: until the next build only the whole is of use then.
  bool has_guests() const { return !guests_.tile.empty(); }

  /// Of the coarsest level.
  std::size_t columns() const {
    return whole_.levels.empty() ? 0 : static_cast<std::size_t>(whole_.levels.back().columns);
  }

  /// How far lines may stand from their cells, in reaches of their level.
  double stray() const;

  /// Pairs of slots that may touch in the span, of the slots [begin, end) with all after them: found(slot, slot, ...).
  /// Returns how many pairs were tested.
  template<class Found>
  std::uint64_t sweep_pairs(std::size_t begin, std::size_t end, const LineSpan& span, std::vector<LinePair>& buffer,
                            const Found& found) const;

  /// Slots that may touch a line in the span, put into the buffer; returns how many. The part encloses the line.
  std::size_t near(const MirrorPart& part, const Line& line, const LineSpan& span,
                   std::vector<std::uint32_t>& buffer) const;

  /// Gives back most of the memory; a build must follow before anything else.
  void release() {
    lines_ = {};
    unsorted_ = {};
  }

  /// Three calls for a place, some time apart, bring what looking around it needs into the cache.
  void prefetch(std::size_t place, int stage) const;

  std::size_t bytes() const;

private:
  static constexpr int most_levels = 32;

  struct Measured;

  void take_lines(const Particles& particles);
  std::size_t lay_out_cells();
  void sort(std::size_t cells);
  int level_of(const Line& line) const;
  std::size_t cell_of(const Line& line, const MirrorLevel& level) const;
  double reach_x(const Line& line) const { return line.size + window_.half_length * std::fabs(line.u); }
  double reach_y(const Line& line) const { return line.size + window_.half_length * std::fabs(line.v); }
  struct Columns {
    std::int64_t first, last; // beyond the box's edges they count on
  };
  Columns columns_near(const MirrorLevel& level, const Line& line) const;
  // The places that a line, or each of several, takes in a span: so many metres around one.
  struct Lookout {
    std::int64_t x;  // across
    std::uint32_t y; // along
    double around_x, around_y;
    double reach_x; // of the lines in the whole window
  };
  Lookout lookout(std::size_t first, std::size_t last) const;
  Lookout lookout(const Line& line, const LineSpan& span) const;
  std::size_t group_end(std::size_t first, std::size_t end, const MirrorLevel& level) const;
  template<class Cells>
  void cells_in(const MirrorLevel& level, const Lookout& from, std::uint32_t after, const Cells& cells) const;
  template<class Range>
  void ranges_in(const MirrorLevel& level, const Lookout& from, std::uint32_t after, const Range& range) const;
  template<class Cells>
  void rows_in(const MirrorLevel& level, std::size_t cell, std::uint32_t y, std::int64_t far, const Cells& cells) const;
  struct Outside {
    double x, y; // m
  };
  Outside outside(const Line& line, const MirrorLevel& level, std::size_t cell) const;
  void lay_out_tiles(std::size_t particles);
  bool make_guest(std::size_t place, const Line& line);
  static const MirrorLevel& level_at(const std::vector<MirrorLevel>& levels, std::size_t cell);
  static std::uint32_t along(const Line& line) { return static_cast<std::uint32_t>(line.y) + (std::uint32_t{1} << 31); }
  // Where to look for those whose images stand so many boxes outward.
  std::uint32_t image_y(std::uint32_t y, int boxes) const {
    return y + static_cast<std::uint32_t>(boxes) * static_cast<std::uint32_t>(frame_.offset_y);
  }

  ShearingBox box_;
  Frequencies frequencies_;
  MirrorWindow window_;
  Rotation to_middle_;
  double offset_ = 0.0;                                 // at the middle
  double least_radius_ = 1.0, next_least_radius_ = 1.0; // of the last build's particles: where levels begin, no more
  bool one_image_ = false;
  MirrorMeans means_;
  LineFrame frame_{};
  double per_metre_x_ = 0.0, per_metre_y_ = 0.0; // box fractions, in units of 2⁻³²
  LineSweeps sweeps_ = line_sweeps(choose_instruction_set());

  std::vector<Line> unsorted_; // by place, while building; then notes
  MirrorPart whole_;
  int level_index_[most_levels] = {}; // of level_of()
  std::vector<std::uint32_t> starts_; // first slot of each cell
  std::vector<std::uint32_t> cells_;  // of each place
  std::vector<std::uint32_t> slots_;  // of each place
  std::vector<Line> lines_;           // by slot: of cells, of guests, padding

  // Those whose lines left their levels, numbered as they came. Their old slots are blank.
  struct Guests {
    MirrorLevel tiles;
    std::vector<std::uint32_t> last;   // of each tile: 1 + the guest that came last; 0: none
    std::vector<std::uint32_t> before; // of each guest: the same of the one that came before
    std::vector<std::uint32_t> tile;   // of each guest
    std::size_t room = 0;
  };
  Guests guests_;
};

inline Mirror::Columns Mirror::columns_near(const MirrorLevel& level, const Line& line) const {
  const double metres = reach_x(line) + level.reach_x + level.stray_x;
  const std::int64_t far = static_cast<std::int64_t>(metres * per_metre_x_) + 8, x = across(line); // beyond a lookout's
  return {(x - far) * level.columns >> 32, (x + far) * level.columns >> 32};
}

// The level's cells within reach, from and to; of columns that end before slot `after` none. Of guests' tiles all.
template<class Cells>
void Mirror::cells_in(const MirrorLevel& level, const Lookout& from, std::uint32_t after, const Cells& cells) const {
  const double sheared = box_.shear * window_.half_length * (from.reach_x + level.reach_x);
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

// Slots from `after` on that lie in these cells.
template<class Range>
void Mirror::ranges_in(const MirrorLevel& level, const Lookout& from, std::uint32_t after, const Range& range) const {
  if (level.end <= after)
    return;
  cells_in(level, from, after, [&](std::size_t from_cell, std::size_t to_cell) {
    const std::uint32_t begin = std::max(starts_[from_cell], after), end = starts_[to_cell];
    if (begin < end)
      range(begin, end);
  });
}

// The cells of one column, the first of which is `cell`, within reach of a place along the orbit; the box is round.
template<class Cells>
void Mirror::rows_in(const MirrorLevel& level, std::size_t cell, std::uint32_t y, std::int64_t far,
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
std::uint64_t Mirror::sweep_pairs(std::size_t begin, std::size_t end, const LineSpan& span,
                                  std::vector<LinePair>& buffer, const Found& found) const {
  std::uint64_t tested = 0;
  // the slots [first, last) with the others of a range
  const auto sweep = [&](std::size_t first, std::size_t last, std::uint32_t low, std::uint32_t high) {
    const std::size_t most = (last - first) * (high - low);
    if (buffer.size() < most)
      buffer.resize(most);
    const std::size_t count = sweeps_.group(lines_.data(), first, last, frame_, span, low, high, buffer.data());
    for (std::size_t k = 0; k < count; ++k)
      found(buffer[k].first, buffer[k].second);
    tested += most;
    for (std::size_t slot = first + 1; low > first && slot < last; ++slot) // behind itself only
      tested -= std::min<std::size_t>(std::max<std::size_t>(slot + 1, low), high) - low;
  };
  auto own = whole_.levels.begin();
  for (std::size_t first = begin, last = begin; first < end; first = last) {
    while (first >= own->end)
      ++own;
    last = group_end(first, std::min<std::size_t>(end, own->end), *own);
    ranges_in(*own, lookout(first, last), static_cast<std::uint32_t>(first) + 1,
              [&](std::uint32_t low, std::uint32_t high) { sweep(first, last, low, high); });
    if (own == whole_.levels.begin())
      continue;
    for (std::size_t slot = first; slot < last; ++slot) { // finer ones are much smaller than the group
      const Lookout from = lookout(slot, slot + 1);
      for (auto finer = whole_.levels.begin(); finer != own; ++finer)
        ranges_in(*finer, from, 0, [&](std::uint32_t low, std::uint32_t high) { sweep(slot, slot + 1, low, high); });
    }
  }
  return tested;
}

} // namespace keeler
