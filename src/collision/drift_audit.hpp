// Compares the neighbours of a step with the plain search (plain_search.hpp).
#pragma once

#include "broad_phase.hpp"
#include "candidate.hpp"
#include "step_context.hpp"
#include "step_history.hpp"

#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/finders/straight_line.hpp>

#include <cstdint>
#include <span>

namespace keeler::collision {

/// Searches for partners of a random sample of the particles at the begin of a step. Candidates must have all.
void audit_begin(NeighbourAudit& audit, const StepContext& step, const finders::StraightLineTest& test,
                 const CandidateBlocks& candidates);

/// Searches for partners of some of the dirty particles at the end of a step. The broad phase must offer all.
void audit_end(NeighbourAudit& audit, const StepContext& step, const finders::StraightLineTest& test,
               const BroadPhase& broad_phase, const StepHistory& history, std::span<const std::uint32_t> dirty);

} // namespace keeler::collision
