// Transpose of the half spectrum over ranks, between the transforms along y and x: by columns, where a rank has all
// waves of its interpolated columns (mesh_partition.hpp), and by waves, where it has all columns of its waves.
//
// Layout by waves: the columns of all parts follow each other, and each part begins a block. So what two ranks
// exchange is a set of whole blocks at a constant stride on one side and one run of them on the other, which MPI sends
// and receives in place.
//
// The waves of each rank come in batches, one after the other, so that only a part of them needs memory beside the
// spectrum by columns. Each wave is transformed alone, so batches change no bit.
//
// The three last columns of a part are ghosts, the first ones of the next part. Both ranks transform them; in the
// layout by waves the later part's values overwrite the ghosts (HalfSpectrum).
#pragma once

#include "index_range.hpp"
#include "mesh_partition.hpp"
#include "sheared_transform.hpp"

#include <keeler/comm/communicator.hpp>

#include <span>
#include <vector>

namespace keeler::gravity {

/// The layout of one solve.
class SpectrumTranspose {
public:
  SpectrumTranspose(const MeshPartition& partition, const MeshShape& shape);

  std::size_t batches() const { return batches_; }

  /// Send a batch of the spectrum by columns to that by waves, which gets the waves of this batch and rank and the
  /// columns of all ranks, and back. Precondition: by_columns has the interpolated columns of this rank and all waves.
  /// Collective.
  void to_waves(std::size_t batch, HalfSpectrum& by_columns, HalfSpectrum& by_waves, const Communicator& ranks) const;
  void to_columns(std::size_t batch, HalfSpectrum& by_waves, HalfSpectrum& by_columns, const Communicator& ranks) const;

private:
  IndexRange waves(std::size_t rank, std::size_t batch) const;
  std::vector<comm::Blocks> blocks_by_columns(std::size_t batch, HalfSpectrum& by_columns) const;
  std::vector<comm::Blocks> blocks_by_waves(HalfSpectrum& by_waves) const;

  std::size_t planes_, batches_;
  std::vector<IndexRange> columns_; // of all parts, ascending
  std::vector<IndexRange> blocks_;  // per rank: its blocks in the layout by waves
  std::vector<IndexRange> waves_;   // per rank
};

} // namespace keeler::gravity
