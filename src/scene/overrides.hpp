// Overrides on top of a scene file: "a.b=value" of the command line, or keys of another file.
#pragma once

#include "document.hpp"

#include <keeler/scene/scene.hpp>

#include <string>
#include <vector>

namespace keeler {

/// Puts an override into the document. What the file says against an override (another way to give the same thing, a
/// key of another law, the sections that a start file replaces) is dropped, with a notice each.
void apply_override(SceneDocument& document, const Override& by, std::vector<std::string>& notices);

/// The same for those of the command line, in their order. Throws UsageError where one is not KEY=VALUE, and where they
/// are more than a scene can have.
void apply_overrides(SceneDocument& document, const std::vector<std::string>& overrides,
                     std::vector<std::string>& notices);

/// The same for the snapshot of --from.
void apply_start(SceneDocument& document, const std::string& snapshot, std::vector<std::string>& notices);

/// Makes a scene complete whose particles a table gives: of what it says of particles only the density stays, and what
/// it must say gets values that nobody reads. Throws UsageError where the table leaves the box or the start undefined.
void apply_table(SceneDocument& document);

} // namespace keeler
