#include <keeler/report/document.hpp>

#include <keeler/core/format.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/html.hpp>

#include <fmt/format.h>

#include <cstddef>

namespace keeler::report {
namespace {

// Returns text for one cell of a Markdown table: on one line, | escaped.
std::string in_cell(const std::string& text) {
  std::string cell;
  for (const char c : printable_line(text))
    cell += c == '|' ? "\\|" : std::string(1, c);
  return cell;
}

} // namespace

Document::Document(const std::string& title) : title_(title), markdown_("# " + title + "\n") {}

void Document::heading(const std::string& text) {
  markdown_ += "\n## " + text + "\n";
  body_ += "<h2>" + html_inline(text) + "</h2>\n";
}

void Document::paragraph(const std::string& text) {
  markdown_ += "\n" + text + "\n";
  body_ += "<p>" + html_inline(text) + "</p>\n";
}

void Document::table(const std::vector<std::vector<std::string>>& rows) {
  markdown_ += "\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const std::string& text : rows[k])
      markdown_ += "| " + in_cell(text) + " ";
    markdown_ += "|\n";
    if (k == 0) {
      for (std::size_t column = 0; column < rows[k].size(); ++column)
        markdown_ += "|---";
      markdown_ += "|\n";
    }
  }
  body_ += html_table(rows);
}

void Document::figure(const std::filesystem::path& folder, const std::string& name, const std::string& caption) {
  const std::string path = folder.filename().string() + "/" + name;
  const bool vector = std::filesystem::exists(folder / (name + ".svg"));
  markdown_ += fmt::format("\n![{}]({}.{})\n\n*{}*\n", name, path, vector ? "svg" : "png", caption);
  const std::string type = vector ? "svg+xml" : "png";
  body_ += fmt::format("<figure><img alt=\"{}\" src=\"data:image/{};base64,{}\"><figcaption>{}</figcaption></figure>\n",
                       name, type, base64(files::read_file(folder / (name + (vector ? ".svg" : ".png")))),
                       html_inline(caption));
}

std::string Document::html() const {
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>"
                     "body{{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}}"
                     "table{{border-collapse:collapse;font-size:14px}}td,th{{border:1px solid #bbb;padding:.2em .5em;"
                     "text-align:left}}img{{max-width:100%}}figcaption{{font-style:italic}}</style></head>\n"
                     "<body>\n<h1>{0}</h1>\n{1}</body></html>\n",
                     html_text(title_), body_);
}

} // namespace keeler::report
