// Small pieces of HTML pages.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// Text as it stands between tags: &, < and > are written as entities.
std::string html_text(const std::string& text);

/// The same, and Markdown's `code` and **bold** are understood.
std::string html_inline(const std::string& text);

/// The first row names the columns. Cells as html_inline().
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// Bytes in the digits of RFC 4648.
std::string base64(std::span<const std::byte> bytes);

} // namespace keeler
