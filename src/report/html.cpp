#include <keeler/report/html.hpp>

#include <keeler/core/printable.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::report {
namespace {

// Replaces the marks alternately by the opening and closing tags of the element.
void replace_marks(std::string& text, const std::string& mark, const std::string& element) {
  bool open = false;
  assert(!mark.empty());
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
    const std::string tag = fmt::format("<{}{}>", open ? "/" : "", element);
    text.replace(at, mark.size(), tag);
    at += tag.size();
    open = !open;
  }
}

std::string row_html(const std::vector<std::string>& row, const char* cell) {
  std::string out = "<tr>";
  for (const std::string& text : row)
    out += fmt::format("<{0}>{1}</{0}>", cell, html_inline(text));
  return out + "</tr>\n";
}

} // namespace

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : printable_text(text)) // XML has no control characters
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  return out;
}

std::string html_inline(const std::string& text) {
  std::string out = html_text(text);
  replace_marks(out, "**", "b");
  replace_marks(out, "`", "code");
  return out;
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<table>\n";
  for (std::size_t k = 0; k < rows.size(); ++k)
    out += row_html(rows[k], k == 0 ? "th" : "td");
  return out + "</table>\n";
}

std::string base64(std::span<const std::byte> bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    unsigned group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? std::to_integer<unsigned>(bytes[k + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      out += k + i <= bytes.size() ? digits[group >> (18 - 6 * i) & 63U] : '=';
  }
  return out;
}

} // namespace keeler::report
