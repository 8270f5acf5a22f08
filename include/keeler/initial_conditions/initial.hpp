// The initial state of a scene.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <functional>
#include <string>

namespace keeler::scene {
struct PatchScale;
} // namespace keeler::scene

namespace keeler::initial_conditions {

/// Progress of making a start.
struct StartProgress {
  double fraction = 0.0;    ///< of the work done, an estimate; 1 at the end
  double elapsed_s = 0.0;   ///< wall time
  double remaining_s = 0.0; ///< an estimate
};

/// Returns a fresh patch on the scene's streamlines, or the snapshot that the scene names. Throws UsageError (too
/// dense), Interrupted (interrupt.hpp), or what patch_from_snapshot() throws. Collective: each rank gets a part of the
/// particles, and the root all other data. `progress` may throw if it throws on all ranks.
Patch initial_patch(const Scene& scene, const std::function<void(const StartProgress&)>& progress = {},
                    const Communicator& ranks = {});

/// Throws IoError if the snapshot that the scene starts from does not exist.
void require_start_file(const Scene& scene);

/// Returns the patch of a snapshot as the start of a run of this scene: with the scene's frequencies, the patch's own
/// box, and time zero. Throws IoError; UsageError if it was made at another orbit; InvariantError for an invalid
/// particle, which it names.
Patch patch_from_snapshot(const std::string& path, const Scene& scene);
/// As above, for a snapshot that has been read; messages name it by `path`. Collective, for a part of the particles.
Patch patch_from_snapshot(Patch patch, const std::string& path, const Scene& scene, const Communicator& ranks = {});

/// Returns the size of a patch, for warnings. Collective, for a part of the particles: on the root.
scene::PatchScale scale_of(const Patch& patch, const Communicator& ranks = {});

} // namespace keeler::initial_conditions

namespace keeler {
using initial_conditions::initial_patch;
} // namespace keeler
