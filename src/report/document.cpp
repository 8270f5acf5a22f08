#include <keeler/report/document.hpp>

#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <cstddef>

namespace keeler {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
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

// Every other occurrence of the mark opens or closes the element.
void replace_marks(std::string& text, const std::string& mark, const std::string& element) {
  bool open = false;
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
    const std::string tag = fmt::format("<{}{}>", open ? "/" : "", element);
    text.replace(at, mark.size(), tag);
    at += tag.size();
    open = !open;
  }
}

std::string inline_html(const std::string& text) {
  std::string out = escaped(text);
  replace_marks(out, "**", "b");
  replace_marks(out, "`", "code");
  return out;
}

std::string base64(const std::vector<std::byte>& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    unsigned group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? std::to_integer<unsigned>(bytes[k + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      out += k + i <= bytes.size() ? digits[group >> (18 - 6 * i) & 63U] : '=';
  }
  return out;
}

std::string row_html(const std::vector<std::string>& row, const char* cell) {
  std::string out = "<tr>";
  for (const std::string& text : row)
    out += fmt::format("<{0}>{1}</{0}>", cell, inline_html(text));
  return out + "</tr>\n";
}

} // namespace

Document::Document(const std::string& title) : title_(title), markdown_("# " + title + "\n") {}

void Document::heading(const std::string& text) {
  markdown_ += "\n## " + text + "\n";
  body_ += "<h2>" + inline_html(text) + "</h2>\n";
}

void Document::paragraph(const std::string& text) {
  markdown_ += "\n" + text + "\n";
  body_ += "<p>" + inline_html(text) + "</p>\n";
}

void Document::table(const std::vector<std::vector<std::string>>& rows) {
  markdown_ += "\n";
  body_ += "<table>\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const std::string& text : rows[k])
      markdown_ += "| " + text + " ";
    markdown_ += "|\n";
    if (k == 0) {
      for (std::size_t column = 0; column < rows[k].size(); ++column)
        markdown_ += "|---";
      markdown_ += "|\n";
    }
    body_ += row_html(rows[k], k == 0 ? "th" : "td");
  }
  body_ += "</table>\n";
}

void Document::figure(const std::filesystem::path& folder, const std::string& name, const std::string& caption) {
  const std::string place = folder.filename().string() + "/" + name;
  const bool vector = std::filesystem::exists(folder / (name + ".svg"));
  markdown_ += fmt::format("\n![{}]({}.{})\n\n*{}*\n", name, place, vector ? "svg" : "png", caption);
  const std::string type = vector ? "svg+xml" : "png";
  body_ +=
      fmt::format("<figure><img alt=\"{}\" src=\"data:image/{};base64,{}\"><figcaption>{}</figcaption></figure>\n",
                  name, type, base64(read_file(folder / (name + (vector ? ".svg" : ".png")))), inline_html(caption));
}

std::string Document::html() const {
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>"
                     "body{{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}}"
                     "table{{border-collapse:collapse;font-size:14px}}td,th{{border:1px solid #bbb;padding:.2em .5em;"
                     "text-align:left}}img{{max-width:100%}}figcaption{{font-style:italic}}</style></head>\n"
                     "<body>\n<h1>{0}</h1>\n{1}</body></html>\n",
                     escaped(title_), body_);
}

} // namespace keeler
