// A scene's text with some of its keys changed, and all else as its author wrote it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace keeler {

struct KeyChange {
  std::string path;                 ///< "gravity.kick_every"
  std::optional<std::string> value; ///< TOML; none: the key goes
  std::string comment;              ///< a line of its own above the key; empty: none
};

/// `name` stands for the file in messages. Keys that are not there yet go to the top of their table, which must be
/// there. Throws UsageError where the text is not TOML, or written in a way that no key can be put into.
std::string edit_scene(const std::string& text, const std::string& name, const std::vector<KeyChange>& changes);

} // namespace keeler
