// Changes keys in a TOML text and leaves everything else as its author wrote it.
#pragma once

#include <keeler/config/schema.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

struct KeyChange {
  std::string path;                 ///< "gravity.kick_every"
  std::optional<std::string> value; ///< TOML; none: the key is removed
  std::string comment;              ///< a line above the key; empty: none
};

/// Returns the changed text; messages call it `name`. New keys are inserted at the top of their table.
/// Throws UsageError if the text is not TOML, if a table is absent, or if it is written such that no key can be
/// inserted.
std::string edit_document(const Schema& schema, const std::string& text, const std::string& name,
                          const std::vector<KeyChange>& changes);

} // namespace keeler
