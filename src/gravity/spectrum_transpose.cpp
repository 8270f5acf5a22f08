#include "spectrum_transpose.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::gravity {

SpectrumTranspose::SpectrumTranspose(const MeshPartition& partition) : blocks_(partition.parts().size()) {
  const std::span<const MeshPart> parts = partition.parts();
  for (const MeshPart& part : parts)
    waves_.push_back(part.waves);
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return parts[a].interpolated.begin < parts[b].interpolated.begin; });
  std::size_t next = 0;
  for (const std::size_t rank : order) {
    const IndexRange& columns = parts[rank].interpolated;
    const std::size_t count = (columns.size() + HalfSpectrum::block - 1) / HalfSpectrum::block;
    columns_.push_back(columns);
    blocks_[rank] = {next, next + count};
    next += count;
  }
}

// Returns, per rank, that rank's waves of all columns of this one.
std::vector<comm::Blocks> SpectrumTranspose::blocks_by_columns(HalfSpectrum& by_columns) const {
  std::vector<comm::Blocks> blocks;
  for (const IndexRange& waves : waves_)
    blocks.push_back(by_columns.part({0, by_columns.blocks()}, waves));
  return blocks;
}

// Returns, per rank, that rank's columns of all waves of this one.
std::vector<comm::Blocks> SpectrumTranspose::blocks_by_waves(HalfSpectrum& by_waves, const Communicator& ranks) const {
  std::vector<comm::Blocks> blocks;
  for (const IndexRange& columns : blocks_)
    blocks.push_back(by_waves.part(columns, waves_[ranks.rank()]));
  return blocks;
}

void SpectrumTranspose::to_waves(HalfSpectrum& by_columns, HalfSpectrum& by_waves, const Communicator& ranks) const {
  assert(by_columns.blocks() == blocks_[ranks.rank()].size());
  assert(by_waves.waves().size() == waves_[ranks.rank()].size());
  ranks.exchange(blocks_by_columns(by_columns), blocks_by_waves(by_waves, ranks));
}

void SpectrumTranspose::to_columns(HalfSpectrum& by_waves, HalfSpectrum& by_columns, const Communicator& ranks) const {
  assert(by_columns.blocks() == blocks_[ranks.rank()].size());
  assert(by_waves.waves().size() == waves_[ranks.rank()].size());
  ranks.exchange(blocks_by_waves(by_waves, ranks), blocks_by_columns(by_columns));
}

} // namespace keeler::gravity
