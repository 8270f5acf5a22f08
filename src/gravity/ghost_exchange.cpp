#include "ghost_exchange.hpp"

#include <keeler/core/memory.hpp>

#include <algorithm>
#include <numeric>

namespace keeler::gravity {

GhostExchange::GhostExchange(std::vector<FoldedParticle>& particles, std::span<const std::uint64_t> per_column,
                             const TileFinder& find, const MeshPartition& partition, const Communicator& ranks)
    : sent_to_(ranks.size()), assigned_from_(ranks.size()) {
  assert(std::accumulate(per_column.begin(), per_column.end(), std::uint64_t{0}) == particles.size());
  Buffers buffers = make_buffers(per_column, partition, ranks.rank());
  reserve(per_column, partition, ranks.rank());
  pack(particles, find, partition, ranks.rank(), buffers);
  buffers = ranks.exchange(buffers);
  append(particles, buffers, find, partition.own().assigned);
  needed_ = particles.size();
}

// Returns empty buffers with the capacity for all particles that other ranks need.
GhostExchange::Buffers GhostExchange::make_buffers(std::span<const std::uint64_t> per_column,
                                                   const MeshPartition& partition, std::size_t own_rank) {
  std::vector<std::size_t> sizes(partition.parts().size(), 0);
  for (std::size_t column = 0; column < per_column.size(); ++column)
    for (const std::uint32_t rank : partition.ranks_needing_column(column))
      sizes[rank] += rank == own_rank ? 0 : per_column[column];
  Buffers buffers(sizes.size());
  for (std::size_t rank = 0; rank < sizes.size(); ++rank)
    buffers[rank].reserve(sizes[rank]);
  return buffers;
}

// Reserves the lists of particles sent.
void GhostExchange::reserve(std::span<const std::uint64_t> per_column, const MeshPartition& partition,
                            std::size_t own_rank) {
  for (std::size_t rank = 0; rank < sent_to_.size(); ++rank) {
    const IndexRange& assigned = partition.parts()[rank].assigned;
    const auto counts = per_column.subspan(assigned.begin, assigned.size());
    sent_to_[rank].reserve(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  }
  assigned_from_[own_rank].reserve(sent_to_[own_rank].capacity());
}

// Packs the particles that other ranks need, and keeps the ones that this rank needs.
void GhostExchange::pack(std::vector<FoldedParticle>& particles, const TileFinder& find, const MeshPartition& partition,
                         std::size_t own_rank, Buffers& buffers) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const FoldedParticle particle = particles[k];
    const std::size_t column = find.column(particle.x);
    for (const std::uint32_t rank : partition.ranks_needing_column(column)) {
      const bool is_mesh_rank = partition.parts()[rank].assigned.contains(column);
      if (is_mesh_rank)
        sent_to_[rank].push_back(static_cast<std::uint32_t>(k));
      if (rank != own_rank) {
        buffers[rank].push_back(particle);
        continue;
      }
      if (is_mesh_rank)
        assigned_from_[rank].push_back(static_cast<std::uint32_t>(kept));
      particles[kept++] = particle;
    }
  }
  // each particle has exactly one mesh rank
  assert(std::accumulate(sent_to_.begin(), sent_to_.end(), std::size_t{0},
                         [](std::size_t sum, const auto& sent) { return sum + sent.size(); }) == particles.size());
  particles.resize(kept);
}

// Appends the received particles, and frees the buffers one by one.
void GhostExchange::append(std::vector<FoldedParticle>& particles, Buffers& received, const TileFinder& find,
                           const IndexRange& assigned) {
  std::size_t needed = particles.size();
  for (const std::vector<FoldedParticle>& from_rank : received)
    needed += from_rank.size();
  if (particles.capacity() < needed)
    particles.reserve(needed + needed / 16);
  for (std::size_t rank = 0; rank < received.size(); ++rank) {
    for (const FoldedParticle& particle : received[rank]) {
      if (assigned.contains(find.column(particle.x)))
        assigned_from_[rank].push_back(static_cast<std::uint32_t>(particles.size()));
      particles.push_back(particle);
    }
    free_memory(received[rank]);
  }
  assert(particles.size() == needed);
}

} // namespace keeler::gravity
