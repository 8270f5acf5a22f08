// Reference paths: the straight line of each particle about the middle of the lists' lifetime, with a skin. (Donev,
// Torquato & Stillinger 2005 call it the bounding neighbourhood of the particle.)
//
// Two particles are neighbours if their reference paths, both widened by the skin, come into contact within the
// lifetime. The skin is thus half of Verlet's (1967), which is counted per pair.
#pragma once

#include "line_cells.hpp"
#include "path_lines.hpp"
#include "step_interval.hpp"

#include <span>
#include <vector>

namespace keeler::collision {

class ReferencePaths {
public:
  /// Sets the part of the box that the particles of the following rebuilds are in.
  void set_folds(const cells::Folds& folds) { folds_ = folds; }

  /// Gives all particles a reference path for `lifetime` steps, the present one included. Returns true if nearest
  /// images suffice for all pairs. `buffer` is overwritten. Throws InvariantError if elements are not finite.
  bool rebuild(const SearchContext& step, int lifetime, std::vector<Line>& buffer);

  /// Begins the next step.
  void begin_step() { ++lifetime_.age; }

  /// Gives particle i a reference path from its present path; `to_middle`: to_middle_of_rest(). Returns true if nearest
  /// images suffice for its pairs. Precondition: its elements are finite.
  bool renew(const SearchContext& step, std::size_t i, const Rotation& to_middle);
  Rotation to_middle_of_rest(const SearchContext& step) const {
    return {step.frequencies, lifetime_.to_middle_of_rest(step.step)};
  }

  /// Returns the neighbours of particle i in the rest of the lifetime, including i itself, in `buffer`. Adds to
  /// `tested` the number of lines tested.
  std::span<const std::uint32_t> find_neighbours(const SearchContext& step, std::size_t i,
                                                 std::vector<std::uint32_t>& buffer, std::uint64_t& tested) const;

  const StepInterval& lifetime() const { return lifetime_; }
  const LineCells& cells() const { return cells_; }
  const Line* lines() const { return lines_.data(); } ///< by particle; `size` is radius + skin + curvature
  const Line& line(std::size_t i) const { return lines_[i]; }

  /// Returns the position of a reference path at the middle of the lifetime.
  BoxPosition position(std::size_t i) const { return position_of(lines_[i]); }

  void release() { cells_.release(); }
  /// True if there are lines of so many particles, and the cells hold them with rounding.
  bool sound(std::size_t particles) const;
  std::size_t bytes() const { return cells_.bytes() + lines_.capacity() * sizeof(Line); }

private:
  StepInterval lifetime_;
  cells::Folds folds_;
  double skin_ = 0.0; // m
  double mean_radius_ = 0.0, min_radius_ = 0.0;
  std::vector<Line> lines_;
  LineCells cells_; // hold the lines, with rounding in their size
};

} // namespace keeler::collision
