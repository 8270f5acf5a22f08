// The state that a scene starts from.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler {

/// A fresh patch on the scene's streamlines, or the snapshot that the scene names. Throws UsageError (too dense) or
/// IoError (the snapshot).
Patch initial_patch(const Scene& scene);

/// The patch of a snapshot, made the start of a run of this scene: the scene's frequencies, its own box, time zero.
/// Throws IoError.
Patch patch_from_snapshot(const std::string& path, const Scene& scene);

} // namespace keeler
