// Exchange of particles between their owners and the parts of the mesh (mesh_partition.hpp).
//
// A particle's owner is the rank that passes it to the solve; its mesh rank is the one that is assigned its column of
// tiles and computes its acceleration. Other ranks that need the column get a ghost of it. For most particles owner and
// mesh rank are the same, and they are not sent there.
//
// Invariant: owner o lists the particles that it sent to mesh rank m in the order in which m lists the assigned
// particles received from o. So results return without indices.
#pragma once

#include "mesh_partition.hpp"
#include "sorted_particles.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/core/vector.hpp>

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::gravity {

class GhostExchange {
public:
  /// Sends particles to all ranks that need them. `particles` has on entry the particles that this rank owns, on return
  /// all that it needs. Precondition: `per_column` counts them per column of tiles. Collective.
  GhostExchange(std::vector<FoldedParticle>& particles, std::span<const std::uint64_t> per_column,
                const TileFinder& find, const MeshPartition& partition, const Communicator& ranks);

  /// Sends results from the mesh ranks to the owners: calls take(k, value) for each particle k that this rank owns.
  /// `values` has one value per particle needed, in their order. Collective.
  template<class Take>
  void return_to_owners(std::span<const Vec3> values, const Communicator& ranks, const Take& take) const {
    assert(values.size() == needed_);
    using Row = std::array<double, 3>;
    std::vector<std::vector<Row>> rows(ranks.size());
    for (std::size_t rank = 0; rank < rows.size(); ++rank)
      if (rank != ranks.rank()) {
        rows[rank].reserve(assigned_from_[rank].size());
        for (const std::uint32_t k : assigned_from_[rank])
          rows[rank].push_back({values[k].x(), values[k].y(), values[k].z()});
      }
    rows = ranks.exchange(rows);
    for (std::size_t i = 0; i < assigned_from_[ranks.rank()].size(); ++i)
      take(sent_to_[ranks.rank()][i], values[assigned_from_[ranks.rank()][i]]);
    for (std::size_t rank = 0; rank < rows.size(); ++rank) {
      assert(rank == ranks.rank() || rows[rank].size() == sent_to_[rank].size());
      for (std::size_t i = 0; i < rows[rank].size(); ++i)
        take(sent_to_[rank][i], Vec3(rows[rank][i][0], rows[rank][i][1], rows[rank][i][2]));
    }
  }

private:
  using Buffers = std::vector<std::vector<FoldedParticle>>; // per rank

  static Buffers make_buffers(std::span<const std::uint64_t> per_column, const MeshPartition& partition,
                              std::size_t own_rank);
  void reserve(std::span<const std::uint64_t> per_column, const MeshPartition& partition, std::size_t own_rank);
  void pack(std::vector<FoldedParticle>& particles, const TileFinder& find, const MeshPartition& partition,
            std::size_t own_rank, Buffers& buffers);
  void append(std::vector<FoldedParticle>& particles, Buffers& received, const TileFinder& find,
              const IndexRange& assigned);

  std::vector<std::vector<std::uint32_t>> sent_to_;       // per mesh rank: which of the owned particles
  std::vector<std::vector<std::uint32_t>> assigned_from_; // per owner: which of the needed particles
  std::size_t needed_ = 0;
};

} // namespace keeler::gravity
