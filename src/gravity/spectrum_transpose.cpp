#include "spectrum_transpose.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::gravity {

namespace {

// More batches need less memory, and more messages. These are not made so short that they cost their latency.
std::size_t batches_of(const MeshShape& shape, std::size_t ranks) {
  constexpr std::size_t most = 4, least_message = 16384; // bytes, on average
  const std::size_t all = shape.columns * shape.column_length() * sizeof(float);
  return std::clamp<std::size_t>(all / (ranks * ranks) / least_message, 1, most);
}

} // namespace

SpectrumTranspose::SpectrumTranspose(const MeshPartition& partition, const MeshShape& shape)
    : planes_(shape.planes), batches_(batches_of(shape, partition.parts().size())), blocks_(partition.parts().size()) {
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

IndexRange SpectrumTranspose::waves(std::size_t rank, std::size_t batch) const {
  const IndexRange& all = waves_[rank];
  return {all.begin + all.size() * batch / batches_, all.begin + all.size() * (batch + 1) / batches_};
}

// Returns, per rank, that rank's waves of a batch, of all columns of this one.
std::vector<comm::Blocks> SpectrumTranspose::blocks_by_columns(std::size_t batch, HalfSpectrum& by_columns) const {
  std::vector<comm::Blocks> blocks;
  for (std::size_t rank = 0; rank < waves_.size(); ++rank)
    blocks.push_back(by_columns.part({0, by_columns.blocks()}, waves(rank, batch)));
  return blocks;
}

// Returns, per rank, that rank's columns of all waves of this one.
std::vector<comm::Blocks> SpectrumTranspose::blocks_by_waves(HalfSpectrum& by_waves) const {
  std::vector<comm::Blocks> blocks;
  for (const IndexRange& columns : blocks_)
    blocks.push_back(by_waves.part(columns, by_waves.waves()));
  return blocks;
}

void SpectrumTranspose::to_waves(std::size_t batch, HalfSpectrum& by_columns, HalfSpectrum& by_waves,
                                 const Communicator& ranks) const {
  assert(by_columns.blocks() == blocks_[ranks.rank()].size());
  by_waves.reset(columns_, waves(ranks.rank(), batch), planes_);
  ranks.exchange(blocks_by_columns(batch, by_columns), blocks_by_waves(by_waves));
}

void SpectrumTranspose::to_columns(std::size_t batch, HalfSpectrum& by_waves, HalfSpectrum& by_columns,
                                   const Communicator& ranks) const {
  assert(by_columns.blocks() == blocks_[ranks.rank()].size());
  assert(by_waves.waves().begin == waves(ranks.rank(), batch).begin);
  ranks.exchange(blocks_by_waves(by_waves), blocks_by_columns(batch, by_columns));
}

} // namespace keeler::gravity
