// The state that a scene starts from.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/scene.hpp>

#include <functional>
#include <string>

namespace keeler {

/// A fresh patch on the scene's streamlines, or the snapshot that the scene names. Throws UsageError (too dense),
/// Interrupted (interrupt.hpp), or what patch_from_snapshot() throws. Collective: each rank gets a part of the
/// particles, and the first one all else. `progress` may throw where it throws on all ranks.
Patch initial_patch(const Scene& scene, const std::function<void(const StartProgress&)>& progress = {},
                    const Communicator& ranks = {});

/// Throws IoError where the snapshot that the scene starts from does not exist.
void require_start_file(const Scene& scene);

/// The patch of a snapshot, made the start of a run of this scene: the scene's frequencies, its own box, time zero.
/// Throws IoError; UsageError when it was made at another place; InvariantError for a particle that no ring has, named.
Patch patch_from_snapshot(const std::string& path, const Scene& scene);
/// The same of a snapshot that has been read; `path` stands for it in messages. Collective, of a part of the particles.
Patch patch_from_snapshot(Patch patch, const std::string& path, const Scene& scene, const Communicator& ranks = {});

/// How large a patch is, for the doubts about it. Collective, of a part of the particles: on the first rank.
PatchScale scale_of(const Patch& patch, const Communicator& ranks = {});

} // namespace keeler
