// Patches that take minutes to make, stored in the user's cache folder: made once, and read from then on.
//
// A file has the hash of the scene that makes its patch in its name, so it is read for the same scene only. A newer
// program reads the states of an older one: benches of two programs time the same state.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <functional>

namespace keeler::bench {

/// Returns $XDG_CACHE_HOME/keeler, or ~/.cache/keeler without that variable; empty without both.
std::filesystem::path cache_folder();

/// Returns the patch that is stored in `folder` for this scene. If there is none that can be read, makes it and stores
/// it if possible. A made patch that was stored has the bits of the file. Throws what `make` throws.
Patch cached_patch(const std::filesystem::path& folder, const Scene& scene, const std::function<Patch()>& make);

} // namespace keeler::bench
