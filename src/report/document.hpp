// A report composed once and output in two forms: Markdown, and a self-contained HTML page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace keeler::report {

class Document {
public:
  explicit Document(const std::string& title);

  void heading(const std::string& text);
  /// Adds a paragraph. `code` and **bold** are interpreted as in Markdown.
  void paragraph(const std::string& text);
  /// Adds a table. The first row has the names of the columns.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// Adds the picture NAME.svg of the folder, or NAME.png if there is none. The HTML page embeds it. Throws IoError
  /// when it cannot be read.
  void figure(const std::filesystem::path& folder, const std::string& name, const std::string& caption);

  const std::string& markdown() const { return markdown_; }
  std::string html() const;

private:
  std::string title_, markdown_, body_;
};

} // namespace keeler::report
