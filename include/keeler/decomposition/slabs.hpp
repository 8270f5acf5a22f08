// How ranks divide the box: slabs across it, whose particles they own, migration, and copies of neighbours' particles.
//
// A particle stays with its owner until the borders are made anew: when one has gone farther than the margin, or when
// memory is sorted. Where bounds, margins and copies are never shows in a result.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/decomposition/borders.hpp>
#include <keeler/particles/store.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace keeler {

class Slabs {
public:
  /// What a rank holds of the particles it owns: the store, and other rows in its order.
  struct Holding {
    Particles& particles;
    std::vector<std::vector<Vec3>*> rows;
  };

  /// How far copies reach. No result depends on it, but time does.
  struct Reach {
    double growth = 12.0; ///< of the margin, over what one step needs: learnt as steps go by
    /// Rows of spheres of the mean radius beyond the near copies: a wrong path is seldom handed on so often in a step.
    double rows_beyond = 8.0;
  };

  Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies)
      : Slabs(ranks, box, frequencies, Reach()) {}
  Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Reach& reach);

  /// Each particle goes to its owner from the rank that has it, whichever that is; all may be with one.
  void divide(Holding holding);

  /// Whether the borders are good for a step of that length.
  bool serve(const Particles& particles, double step);
  /// For steps of that length and particles where they are at `offset`: particles go to their owners, in the order of
  /// their places, and copies are chosen. Bounds move where the ranks' loads have become uneven.
  void make_borders(Holding holding, double offset, double step);
  /// The borders serve no more.
  void expire() { made_ = false; }
  /// The step could not be done with these borders: the next ones are twice as wide, and so on, until each rank has
  /// copies of all.
  void widen() {
    widest_ = min_margin_ = 2.0 * borders_.margin;
    expire();
  }

  /// Copies behind the own particles, as their owners have them now; and away with them.
  void add_copies(Particles& particles);
  void drop_copies(Particles& particles) const;

  const Borders& borders() const { return borders_; }
  std::uint64_t times_made() const { return times_made_; }

private:
  void learn();
  std::size_t owner(double across) const;
  bool is_within(double across, std::size_t rank, double reach) const;
  template<class Visit> void for_each_within(double across, double reach, const Visit& visit) const;
  void balance(const std::vector<double>& across);
  void migrate(Holding& holding, const std::vector<double>& across) const;
  void lend(const Particles& particles, double step);
  double largest_way(const Particles& particles, const std::vector<double>& references, double step) const;

  Communicator ranks_;
  ShearingBox box_;
  std::vector<double> bounds_; // of slab r: [bounds_[r], bounds_[r + 1]), m
  bool made_ = false;
  Borders borders_;
  Particles copies_; // as they were when the borders were made: all but paths and spins stays
  Reach reach_;
  double widest_ = 0.0;     // the largest way since the borders were made, m
  double min_margin_ = 0.0; // of the next borders, m
  std::uint64_t times_made_ = 0;
};

} // namespace keeler
