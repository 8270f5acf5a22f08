// The state that a scene starts from.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/doubts.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/states/progress.hpp>

#include <functional>
#include <string>

namespace keeler {

/// A fresh patch on the scene's streamlines, or the snapshot that the scene names. Throws UsageError (too dense),
/// Interrupted (interrupt.hpp), or what patch_from_snapshot() throws.
Patch initial_patch(const Scene& scene, const std::function<void(const StartProgress&)>& progress = {});

/// The patch of a snapshot, made the start of a run of this scene: the scene's frequencies, its own box, time zero.
/// Throws IoError; UsageError when it was made at another place; InvariantError for a particle that no ring has, named.
Patch patch_from_snapshot(const std::string& path, const Scene& scene);
/// The same of a snapshot that has been read; `path` stands for it in messages.
Patch patch_from_snapshot(Patch patch, const std::string& path, const Scene& scene);

/// How large a patch is, for the doubts about it.
PatchScale scale_of(const Patch& patch);

} // namespace keeler
