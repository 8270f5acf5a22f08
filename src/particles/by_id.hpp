// Visits the particles of a distributed run in order of their ids, piece by piece, as files need them.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/store.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace keeler::particles {

/// Calls piece(particles) on the root rank for the particles of all ranks, `rows` at a time (fewer in the last piece).
/// Its exceptions are thrown on all ranks. No rank holds more than its local particles and one piece. Collective.
/// Precondition: rows > 0; ids are unique over all ranks.
void visit_by_id(const Particles& local, const Communicator& ranks, std::size_t rows,
                 const std::function<void(const Particles&)>& piece);

/// Returns the ids at these places (from 0) in the order of the ids of all ranks. Collective: all ranks give the same
/// places. Precondition: places are below the number of ids.
std::vector<std::uint64_t> ids_at(std::span<const std::uint64_t> local_ids, const Communicator& ranks,
                                  std::span<const std::size_t> places);

} // namespace keeler::particles
