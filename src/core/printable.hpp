// Makes text safe for terminals.
#pragma once

#include <string>
#include <string_view>

namespace keeler {

/// Returns a text that is safe for terminals, even if it quotes foreign text: control characters except line breaks and
/// tabs, and invalid UTF-8, become '?'.
std::string printable_text(std::string_view text);

/// True if a text is valid UTF-8 (RFC 3629), as TOML and JSON must be; control characters are accepted.
bool is_utf8(std::string_view text);

} // namespace keeler
