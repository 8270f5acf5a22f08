// Documents for particles of another source: a snapshot (--from) or a table of particles.
#pragma once

#include <keeler/config/document.hpp>

#include <string>
#include <vector>

namespace keeler::scene {

/// Sets start.from; messages call it --from. What the file says against it is removed, with a notice each.
void apply_start(config::TomlDocument& document, const std::string& snapshot, std::vector<std::string>& notices);

/// Completes the document of a scene for a table of particles: of [particles] only the density is kept, and needed keys
/// get placeholders. Throws UsageError if the document has start.from or
/// box.size_in_wavelengths.
void apply_table(config::TomlDocument& document);

} // namespace keeler::scene
