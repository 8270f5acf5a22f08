// Domain decomposition: ranks divide the box into blocks (block_grid.hpp). A rank owns the particles of its block and
// holds ghosts of particles near it (ghost_layer.hpp).
//
// A particle keeps its owner until the ghost layer is rebuilt: when a particle has moved farther than the margin, when
// memory is sorted, or when the layer's lifetime is over. No result depends on the blocks, the margin or the choice of
// ghosts.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/decomposition/block_grid.hpp>
#include <keeler/decomposition/ghost_layer.hpp>
#include <keeler/particles/store.hpp>

#include <cstddef>
#include <vector>

namespace keeler::decomposition {

/// What a rank stores of its own particles: the store, and further rows in its order (empty on all ranks, or one row
/// per particle).
struct Holding {
  Particles& particles;
  std::vector<std::vector<Vec3>*> rows;
};

class Blocks {
public:
  /// The division of the box and the width of the ghost layer. They change the cost and no result.
  struct Layout {
    double growth = 12.0; ///< margin over the excursion of one step; adapted as the run goes on
    /// Width of the layer beyond the near ghosts, in diameters of the mean sphere: a wrong path rarely spreads through
    /// more contacts than that in one step.
    double rows_beyond = 8.0;
    std::size_t strips = 0; ///< across x, at most one per rank; 0: with the least cost
  };

  Blocks(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies)
      : Blocks(ranks, box, frequencies, Layout()) {}
  Blocks(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Layout& layout);

  /// Sends each particle to its owner, from any distribution of the particles over the ranks. Collective.
  void distribute(Holding holding);

  /// True if the ghost layer is valid for the step at this epoch. Collective.
  bool is_valid(const Particles& particles, const Epoch& epoch);
  /// Rebuilds the ghost layer for steps from this epoch on: chooses the number of strips, balances the blocks if the
  /// load is uneven, sends particles to their owners, sorts them by cells, and chooses the ghosts. Collective.
  void rebuild(Holding holding, const Epoch& epoch);
  /// Marks the ghost layer as invalid.
  void invalidate() { is_built_ = false; }
  /// Marks the ghost layer as invalid and at least doubles the margin of the next one, for a step that failed with this
  /// layer. Repeated calls end where each rank has ghosts of all particles.
  void widen() {
    assert(is_built_);
    max_excursion_ = min_margin_ = 2.0 * ghosts_.margin;
    invalidate();
  }

  /// Appends the ghosts, in their owners' present state, to the own particles. Collective. Precondition: the ghost
  /// layer is valid and `particles` has own particles only.
  void add_ghosts(Particles& particles);
  /// Appends a row's values for the ghosts to those of the own particles. Collective. Precondition: the ghost layer is
  /// valid and the row has own particles only.
  void add_ghosts(std::vector<Vec3>& row) const;
  /// Removes the ghosts from the store.
  void remove_ghosts(Particles& particles) const;
  /// Removes the ghosts from a row.
  void remove_ghosts(std::vector<Vec3>& row) const { row.resize(ghosts_.own); }

  GhostLayer& ghosts() { return ghosts_; }
  const GhostLayer& ghosts() const { return ghosts_; }
  const BlockGrid& grid() const { return grid_; }
  std::uint64_t rebuilds() const { return rebuilds_; }
  std::uint64_t migrants() const { return migrants_; } ///< particles that this rank sent to new owners in rebuilds

private:
  void adapt_growth();
  std::vector<Point> positions(const Particles& particles, double offset) const;
  std::vector<std::uint64_t> work(std::size_t particles) const;
  cells::Folds folds(const Point& surroundings) const;
  bool choose_strips();
  std::size_t migrate(Holding& holding, const std::vector<Point>& positions) const;
  void choose_reach(const Particles& particles, const std::vector<Point>& positions);
  void choose_ghosts(const Particles& particles);
  template<class Position>
  double max_excursion(const Particles& particles, const std::vector<Position>& references) const;

  Communicator ranks_;
  Layout layout_;
  BlockGrid grid_;
  bool is_built_ = false;
  GhostLayer ghosts_;
  Particles ghost_particles_;  // as sent when the layer was built; paths and spins are updated each step
  Point near_, reach_;         // distances from a block of references of near ghosts and of all ghosts
  double lifetime_ = 0.0;      // of the layer if y is cut, rad
  double max_excursion_ = 0.0; // since the layer was built, m
  double min_margin_ = 0.0;    // of the next layer, m
  std::uint64_t rebuilds_ = 0, migrants_ = 0;
};

} // namespace keeler::decomposition
