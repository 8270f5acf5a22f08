// The particles of a run in the order of their ids, a piece at a time: for whatever needs that order and not all of
// them at once, as files do.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/store.hpp>

#include <cstddef>
#include <functional>

namespace keeler {

/// Collective: on the first rank piece(particles) for the particles of all ranks in turn, `rows` at a time, fewer the
/// last time. What it throws all ranks throw. No rank has more than its own particles and one piece.
void visit_by_id(const Particles& own, const Communicator& ranks, std::size_t rows,
                 const std::function<void(const Particles&)>& piece);

} // namespace keeler
