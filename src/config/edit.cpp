#include <keeler/config/edit.hpp>

#include <keeler/config/document.hpp>
#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler {
namespace {

std::string parent_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string name_of(const std::string& path) {
  return path.substr(path.rfind('.') + 1); // npos + 1 is 0
}

std::size_t line_begin(const std::string& text, std::size_t at) {
  assert(at <= text.size());
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

// Returns the first byte after the line's end.
std::size_t next_line(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

std::size_t first_word(const std::string& text, std::size_t at) {
  return std::min(text.find_first_not_of(" \t", at), text.size());
}

// Inserts a comment above the line that holds byte `at`, with the line's indentation. It replaces an earlier comment
// there that begins with an equal word and a colon.
void put_comment(std::string& text, std::size_t at, const std::string& comment) {
  if (comment.empty())
    return;
  std::size_t begin = line_begin(text, at);
  const std::string line = fmt::format("{}# ", text.substr(begin, first_word(text, begin) - begin));
  const std::string same = line + comment.substr(0, comment.find(':') + 1);
  if (const std::size_t above = begin == 0 ? 0 : line_begin(text, begin - 1);
      text.compare(above, same.size(), same) == 0) {
    text.erase(above, begin - above);
    begin = above;
  }
  text.insert(begin, line + comment + "\n");
}

void put_value(std::string& text, const TextRange& range, const KeyChange& change) {
  assert(change.value && range.begin <= range.end && range.end <= text.size());
  text.replace(range.begin, range.end - range.begin, *change.value);
  put_comment(text, range.begin, change.comment);
}

void put_into_inline_table(std::string& text, const TextRange& table, const KeyChange& change) {
  assert(change.value && text[table.begin] == '{');
  const bool empty = text[text.find_first_not_of(" \t", table.begin + 1)] == '}';
  text.insert(table.begin + 1, fmt::format(" {} = {}{}", name_of(change.path), *change.value, empty ? " " : ","));
  put_comment(text, table.begin, change.comment);
}

// Inserts the key below the header [table], or as a.b = value next to another key that is written so.
void put_line(std::string& text, const TextRange& table, const KeyChange& change) {
  assert(change.value && table.begin <= text.size());
  const std::size_t begin = line_begin(text, table.begin);
  const bool has_header = text[first_word(text, begin)] == '[';
  std::size_t at = begin;
  if (has_header) {
    at = next_line(text, begin);
    if (text[at - 1] != '\n')
      text.insert(at++, "\n");
  }
  text.insert(at, fmt::format("{} = {}\n", has_header ? name_of(change.path) : change.path, *change.value));
  put_comment(text, at, change.comment);
}

void put_new(std::string& text, const std::string& name, const KeyChange& change) {
  const std::string parent = parent_of(change.path);
  const std::optional<TextRange> table = parent.empty() ? TextRange{} : range_in(text, name, parent);
  if (!table)
    return;
  if (!parent.empty() && text[table->begin] == '{')
    put_into_inline_table(text, *table, change);
  else
    put_line(text, *table, change);
}

// Removes the key: with its line, or with a comma if its table is on one line.
void take_out(std::string& text, const TextRange& value, const std::string& path) {
  const std::size_t begin = line_begin(text, value.begin), word = first_word(text, begin);
  const std::size_t key = text.rfind(name_of(path), value.begin);
  const std::string before = text.substr(word, key - word);
  if (before.empty() || before == parent_of(path) + ".") {
    text.erase(begin, next_line(text, value.end) - begin);
    return;
  }
  std::size_t from = key, to = value.end;
  if (const std::size_t after = first_word(text, value.end); after < text.size() && text[after] == ',')
    to = first_word(text, after + 1);
  else if (const std::size_t comma = text.find_last_not_of(" \t", key - 1); text[comma] == ',')
    from = comma;
  text.erase(from, to - from);
}

// True if the edited text says what the change asks for.
bool is_applied(const Schema& schema, const std::string& text, const std::string& name, const KeyChange& change) {
  const TomlDocument document = parse_document(text, name, schema);
  const DocumentEntry* const entry = find_entry(document, change.path);
  if (!entry || !change.value)
    return !entry && !change.value;
  return to_toml(entry->value) ==
         to_toml(parse_override_value(*change.value, change.path, name, name, schema).front().value);
}

} // namespace

std::string edit_document(const Schema& schema, const std::string& text, const std::string& name,
                          const std::vector<KeyChange>& changes) {
  std::string edited = text;
  parse_document(edited, name, schema);
  for (const KeyChange& change : changes) {
    const std::optional<TextRange> value = range_in(edited, name, change.path);
    if (value && change.value)
      put_value(edited, *value, change);
    else if (value)
      take_out(edited, *value, change.path);
    else if (change.value)
      put_new(edited, name, change);
    try {
      if (is_applied(schema, edited, name, change))
        continue;
    } catch (const UsageError&) { // the text is no longer TOML
    }
    throw UsageError(fmt::format(
        "{}: {} cannot be changed in this text (its table is missing or written in several parts); {} by hand", name,
        change.path, change.value ? fmt::format("write {} = {}", change.path, *change.value) : "remove it"));
  }
  return edited;
}

} // namespace keeler
