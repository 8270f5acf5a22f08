// Transpose of the half spectrum over ranks, between the transforms along y and x: by columns, where a rank has all
// waves of its interpolated columns (mesh_partition.hpp), and by waves, where it has all columns of its waves.
//
// Layout by waves: the columns of all parts follow each other, and each part begins a block. So what two ranks
// exchange is a set of whole blocks at a constant stride on one side and one run of them on the other, which MPI sends
// and receives in place.
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

/// The layout of one solve. The spectra are arguments: their memory outlives it.
class SpectrumTranspose {
public:
  explicit SpectrumTranspose(const MeshPartition& partition);

  /// Ranges of columns of all parts, ascending: the columns of the spectrum by waves.
  std::span<const IndexRange> columns() const { return columns_; }

  /// Send the spectrum by columns to that by waves, and back. Precondition: by_columns has the interpolated columns of
  /// this rank and all waves; by_waves has columns() and the waves of this rank. Collective.
  void to_waves(HalfSpectrum& by_columns, HalfSpectrum& by_waves, const Communicator& ranks) const;
  void to_columns(HalfSpectrum& by_waves, HalfSpectrum& by_columns, const Communicator& ranks) const;

private:
  std::vector<comm::Blocks> blocks_by_columns(HalfSpectrum& by_columns) const;
  std::vector<comm::Blocks> blocks_by_waves(HalfSpectrum& by_waves, const Communicator& ranks) const;

  std::vector<IndexRange> columns_;
  std::vector<IndexRange> blocks_; // per rank: its blocks in the layout by waves
  std::vector<IndexRange> waves_;  // per rank
};

} // namespace keeler::gravity
