#include <keeler/files/columns.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/input.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <optional>

namespace keeler::files {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) // from_chars accepts no plus sign
    word.remove_prefix(1);
  double number = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  return fault == std::errc{} && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

// Returns the separator of a line; a blank means any number of blanks and tabs.
char separator_of(std::string_view line) {
  for (const char separator : {',', ';'})
    if (line.find(separator) != line.npos)
      return separator;
  return ' ';
}

// Calls visit(field) for each field of a line. Precondition: the line is not blank.
template<class Visit> void for_each_field(std::string_view line, char separator, const Visit& visit) {
  assert(!trimmed(line).empty());
  const std::string_view ends = separator == ' ' ? std::string_view(" \t") : std::string_view(&separator, 1);
  for (line = trimmed(line);;) {
    const std::size_t end = line.find_first_of(ends);
    visit(trimmed(line.substr(0, end)));
    if (end == line.npos)
      return;
    line.remove_prefix(end + 1);
    if (separator == ' ')
      line = trimmed(line);
  }
}

// Returns the number of fields of a line, or 0 if one of them has several words. Precondition: the line is not blank.
std::size_t count_words(std::string_view line, char separator) {
  std::size_t count = 0;
  bool one_each = true;
  for_each_field(line, separator, [&](std::string_view field) {
    ++count;
    one_each = one_each && field.find_first_of(blanks) == field.npos;
  });
  return one_each ? count : 0;
}

struct Comment {
  std::string_view text;
  std::size_t line = 0;
};

class Parser {
public:
  Parser(std::string_view text, const std::string& name) : rest_(without_byte_order_mark(text)), name_(name) {}

  Columns run() {
    while (next_line()) {
      if (line_.empty())
        continue;
      if (line_.front() == '#') {
        if (columns_.names.empty())
          comments_.push_back({trimmed(line_.substr(1)), number_});
      } else if (!columns_.names.empty()) {
        read_row();
      } else {
        read_first();
      }
    }
    return std::move(columns_);
  }

private:
  [[noreturn]] void fail(const std::string& message) const {
    throw UsageError(fmt::format("{}:{}: {}", name_, number_, message));
  }

  bool next_line() {
    if (rest_.empty())
      return false;
    const std::size_t end = rest_.find('\n');
    line_ = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  // Reads the names, or the first row of numbers if the names are in a comment above it.
  void read_first() {
    const char separator = separator_of(line_);
    bool is_number = false;
    for_each_field(line_, separator, [&](std::string_view field) { is_number = is_number || number_of(field); });
    if (!is_number)
      return read_names(line_, number_);
    const Comment comment = names_above(separator);
    if (comment.text.empty())
      fail("the first row has numbers (it must name the columns); put a line of names above it");
    read_names(comment.text, comment.line);
    read_row();
  }

  // Returns the last comment above the first row that has one word per field, or else the last comment.
  Comment names_above(char separator) const {
    const auto fits = [&](const Comment& comment) {
      return !comment.text.empty() && separator_of(comment.text) == separator &&
             count_words(comment.text, separator) == count_words(line_, separator);
    };
    const auto found = std::find_if(comments_.rbegin(), comments_.rend(), fits);
    return found != comments_.rend() ? *found : comments_.empty() ? Comment{} : comments_.back();
  }

  void read_names(std::string_view line, std::size_t number) {
    separator_ = separator_of(line);
    for_each_field(line, separator_, [&](std::string_view field) {
      if (field.size() > 1 && field.front() == '"' && field.back() == '"')
        field = trimmed(field.substr(1, field.size() - 2));
      columns_.names.emplace_back(field);
    });
    require_names(number);
    columns_.values.resize(columns_.names.size());
    columns_.header_line = number;
  }

  void require_names(std::size_t line) {
    const std::vector<std::string>& names = columns_.names;
    const auto nameless = std::find(names.begin(), names.end(), std::string());
    if (nameless == names.end())
      return;
    number_ = line;
    if (nameless + 1 == names.end())
      fail(fmt::format("the last column has no name (the line ends with a '{0}'); remove it here and at the ends "
                       "of the rows",
                       separator_));
    if (nameless == names.begin())
      fail("the first column has no name (pandas writes its index so); write the table with index=False, or remove "
           "the column");
    fail(fmt::format("column {} has no name; name it or remove it", nameless - names.begin() + 1));
  }

  // True if the line ends with a separator after the last column.
  bool ends_with_separator() const { return separator_ != ' ' && line_.back() == separator_; }

  void read_row() {
    const std::size_t count = columns_.names.size();
    std::size_t column = 0;
    for_each_field(line_, separator_, [&](std::string_view field) {
      if (column < count) {
        const std::optional<double> number = number_of(field);
        if (!number)
          fail(field.empty()
                   ? fmt::format("{} has no value (every row needs all columns); fill it in or remove the row",
                                 columns_.names[column])
                   : fmt::format("{} is '{}' (it must be a number); correct it or remove the row",
                                 columns_.names[column], field));
        columns_.values[column].push_back(*number);
      }
      ++column;
    });
    if (column == count + 1 && ends_with_separator())
      fail(fmt::format("the row ends with a '{0}' (line {1} names {2} columns, and does not); remove that '{0}'",
                       separator_, columns_.header_line, count));
    if (column != count)
      fail(fmt::format("the row has {} of {} values (line {} names the columns); correct or remove it", column, count,
                       columns_.header_line));
    columns_.lines.push_back(number_);
    assert(columns_.values.front().size() == columns_.lines.size());
  }

  std::string_view rest_, line_;
  std::vector<Comment> comments_; // above the first row
  const std::string& name_;
  std::size_t number_ = 0;
  char separator_ = ',';
  Columns columns_;
};

} // namespace

Columns parse_columns(std::string_view text, const std::string& name) {
  refuse_utf16(text, name + ": ");
  return Parser(text, name).run();
}

} // namespace keeler::files
