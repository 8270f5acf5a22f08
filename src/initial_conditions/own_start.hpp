// Starts of the calling program (particles/start.hpp).
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler::initial_conditions {

/// Returns the scene's particles where its start places them, and the moonlets; all are on the root. Collective. Throws
/// UsageError, naming the start, if it gives no possible state of each particle. Precondition: scene.particles.start.
Patch placed_patch(const Scene& scene, const std::vector<HeldBody>& moonlets, const Communicator& ranks);

} // namespace keeler::initial_conditions
