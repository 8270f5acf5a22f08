// A report written once and kept in two forms: Markdown, and one HTML page that needs no other file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

class Document {
public:
  explicit Document(const std::string& title);

  void heading(const std::string& text);
  /// Markdown's `code` and **bold** are understood.
  void paragraph(const std::string& text);
  /// The first row names the columns.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// A picture beside the report, NAME.png; the page holds the picture itself. NAME.svg is taken where it is there.
  void figure(const std::filesystem::path& folder, const std::string& name, const std::string& caption);

  const std::string& markdown() const { return markdown_; }
  std::string html() const;

private:
  std::string title_, markdown_, body_;
};

} // namespace keeler
