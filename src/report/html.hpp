// Small pieces of HTML pages.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace keeler::report {

/// Returns text escaped for use between tags: &, < and > become entities.
std::string html_text(const std::string& text);

/// As html_text(), with `code` and **bold** interpreted as in Markdown.
std::string html_inline(const std::string& text);

/// Returns a table. The first row has the names of the columns; cells are as html_inline().
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// Returns bytes in the base-64 encoding of RFC 4648.
std::string base64(std::span<const std::byte> bytes);

} // namespace keeler::report
