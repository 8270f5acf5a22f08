// Domain decomposition: ranks divide the box into slabs across x. A rank owns the particles of its slab and holds
// ghosts of particles near it (ghost_layer.hpp).
//
// A particle keeps its owner until the ghost layer is rebuilt: when a particle has moved farther than the margin, or
// when memory is sorted. No result depends on the bounds, the margin or the choice of ghosts.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/decomposition/ghost_layer.hpp>
#include <keeler/particles/store.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace keeler::decomposition {

/// What a rank stores of its own particles: the store, and further rows in its order (empty on all ranks, or one row
/// per particle).
struct SlabHolding {
  Particles& particles;
  std::vector<std::vector<Vec3>*> rows;
};

class Slabs {
public:
  /// The width of the ghost layer. It changes the cost and no result.
  struct Reach {
    double growth = 12.0; ///< margin over the excursion of one step; adapted as the run goes on
    /// Width of the layer beyond the near ghosts, in diameters of the mean sphere: a wrong path rarely spreads through
    /// more contacts than that in one step.
    double rows_beyond = 8.0;
  };

  Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies)
      : Slabs(ranks, box, frequencies, Reach()) {}
  Slabs(const Communicator& ranks, const ShearingBox& box, const Frequencies& frequencies, const Reach& reach);

  /// Sends each particle to its owner, from any distribution of the particles over the ranks. Collective.
  void distribute(SlabHolding holding);

  /// True if the ghost layer is valid for a step of this length. Collective.
  bool is_valid(const Particles& particles, double step);
  /// Rebuilds the ghost layer for particles at `offset` and steps of this length: balances the bounds if the load is
  /// uneven, sends particles to their owners, sorts them by cells, and chooses the ghosts. Collective.
  void rebuild(SlabHolding holding, double offset, double step);
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

  const GhostLayer& ghosts() const { return ghosts_; }
  std::uint64_t rebuilds() const { return rebuilds_; }

private:
  void adapt_growth();
  std::size_t owner(double x) const;
  bool is_within(double x, std::size_t rank, double reach) const;
  template<class Visit> void for_each_within(double x, double reach, const Visit& visit) const;
  void balance(const std::vector<double>& x);
  void migrate(SlabHolding& holding, const std::vector<double>& x) const;
  void choose_ghosts(const Particles& particles, double step);
  double max_excursion(const Particles& particles, const std::vector<double>& references, double step) const;

  Communicator ranks_;
  ShearingBox box_;
  std::vector<double> bounds_; // slab r is [bounds_[r], bounds_[r + 1]), m; ascending
  bool is_built_ = false;
  GhostLayer ghosts_;
  Particles ghost_particles_; // as sent when the layer was built; paths and spins are updated each step
  Reach reach_;
  double max_excursion_ = 0.0; // since the layer was built, m
  double min_margin_ = 0.0;    // of the next layer, m
  std::uint64_t rebuilds_ = 0;
};

} // namespace keeler::decomposition
