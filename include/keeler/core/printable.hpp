// Text for terminals.
#pragma once

#include <string>
#include <string_view>

namespace keeler {

/// Returns a text of lines that terminals can take, whatever names, titles and attributes of others are in it: control
/// characters but line breaks and tabs, and what is no UTF-8, become '?'.
std::string printable_text(std::string_view text);

/// Whether a text is UTF-8, control characters included, as TOML and JSON must be (RFC 3629).
bool is_utf8(std::string_view text);

} // namespace keeler
