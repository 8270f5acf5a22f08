#include "document.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <tuple>

namespace keeler {
namespace {

struct Positioned {
  toml::source_position position;
  Entry entry;
};

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

bool is_plain(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string place_of(const std::string& name, const toml::source_position& position) {
  return fmt::format("{}:{}:{}", name, position.line, position.column);
}

std::optional<std::vector<double>> numbers_in(const toml::array& array) {
  std::vector<double> numbers;
  for (const toml::node& element : array) {
    if (!element.is_number())
      return std::nullopt;
    numbers.push_back(*element.value<double>());
  }
  return numbers;
}

std::optional<NumberRows> rows_in(const toml::array& array) {
  NumberRows rows;
  for (const toml::node& element : array) {
    const std::optional<std::vector<double>> row = element.is_array() ? numbers_in(*element.as_array()) : std::nullopt;
    if (!row)
      return std::nullopt;
    rows.push_back(*row);
  }
  return rows;
}

Value value_of_array(const toml::array& array) {
  if (const std::optional<std::vector<double>> numbers = numbers_in(array))
    return *numbers;
  if (const std::optional<NumberRows> rows = rows_in(array))
    return *rows;
  if (array.is_array_of_tables())
    return TableList{array.size()};
  return Unusable{"a list of things that are not numbers"};
}

Value value_of(const toml::node& node) {
  switch (node.type()) {
  case toml::node_type::table:
    return Table{};
  case toml::node_type::array:
    return value_of_array(*node.as_array());
  case toml::node_type::string:
    return node.as_string()->get();
  case toml::node_type::integer:
    return node.as_integer()->get();
  case toml::node_type::floating_point:
    return node.as_floating_point()->get();
  case toml::node_type::boolean:
    return node.as_boolean()->get();
  default:
    return Unusable{"a date or time"};
  }
}

void flatten_list(const toml::array& tables, const std::string& path, const std::string& name,
                  std::vector<Positioned>& entries);

void flatten(const toml::table& table, const std::string& prefix, const std::string& name,
             std::vector<Positioned>& entries) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + (is_plain(key.str()) ? std::string(key.str()) : quoted(key.str()));
    const toml::source_position position = key.source().begin;
    entries.push_back(
        {position, {path, place_of(name, position), place_of(name, node.source().begin), value_of(node)}});
    if (const toml::table* inner = node.as_table())
      flatten(*inner, path + ".", name, entries);
    if (node.is_array_of_tables())
      flatten_list(*node.as_array(), path, name, entries);
  }
}

void flatten_list(const toml::array& tables, const std::string& path, const std::string& name,
                  std::vector<Positioned>& entries) {
  for (std::size_t n = 0; n < tables.size(); ++n) {
    const toml::table& table = *tables[n].as_table();
    const std::string own = fmt::format("{}[{}]", path, n + 1), place = place_of(name, table.source().begin);
    entries.push_back({table.source().begin, {own, place, place, Table{}}});
    flatten(table, own + ".", name, entries);
  }
}

Document flattened(const toml::table& table, const std::string& name) {
  std::vector<Positioned> entries;
  flatten(table, "", name, entries);
  std::stable_sort(entries.begin(), entries.end(), [](const Positioned& a, const Positioned& b) {
    return std::tie(a.position.line, a.position.column) < std::tie(b.position.line, b.position.column);
  });
  Document document;
  for (Positioned& positioned : entries)
    document.push_back(std::move(positioned.entry));
  return document;
}

// The TOML library counts lines from 1 and, in a line, characters of UTF-8 from 1.
std::size_t offset_of(const std::string& text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line)
    at = text.find('\n', at) + 1;
  for (toml::source_index column = 1; column < position.column && at < text.size(); ++column)
    do
      ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80);
  return at;
}

toml::table parsed(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    std::string reason(error.description());
    std::replace_if(
        reason.begin(), reason.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    throw UsageError(fmt::format("{}: not TOML ({}); correct this line", place_of(name, error.source().begin), reason));
  }
}

} // namespace

const Entry* find_entry(const Document& document, const std::string& path) {
  const auto found = std::find_if(document.begin(), document.end(), [&](const Entry& e) { return e.path == path; });
  return found == document.end() ? nullptr : &*found;
}

std::vector<std::string> tables_of(const Document& document, const std::string& section) {
  const Entry* const entry = find_entry(document, section);
  if (!entry)
    return {};
  const auto* const list = std::get_if<TableList>(&entry->value);
  std::vector<std::string> tables;
  for (std::size_t n = 1; list && n <= list->count; ++n)
    tables.push_back(fmt::format("{}[{}]", section, n));
  return list ? tables : std::vector{section};
}

Document parse_document(const std::string& text, const std::string& name) {
  return flattened(parsed(text, name), name);
}

std::optional<TextRange> range_in(const std::string& text, const std::string& name, const std::string& path) {
  const toml::table document = parsed(text, name);
  const toml::node* const node = document.at_path(path).node();
  if (!node)
    return std::nullopt;
  return TextRange{offset_of(text, node->source().begin), offset_of(text, node->source().end)};
}

Document parse_override_value(const std::string& text, const std::string& path, const std::string& place) {
  Document document = {{path, place, place, text, true}};
  try {
    const toml::table table = toml::parse("value = " + text);
    if (table.size() != 1)
      return document; // a line break in the text: not one value
    document = flattened(table, "");
  } catch (const toml::parse_error&) {
    return document; // a bare word
  }
  for (Entry& entry : document)
    entry = {path + entry.path.substr(std::string("value").size()), place, place, entry.value, true};
  return document;
}

void fail_at(const std::string& place, const std::string& message) {
  throw UsageError(place + ": " + message);
}

std::string kind_words(const Value& value) {
  struct Words {
    std::string operator()(bool) const { return "true or false"; }
    std::string operator()(std::int64_t) const { return "a whole number"; }
    std::string operator()(double) const { return "a number with a fraction"; }
    std::string operator()(const std::string&) const { return "a string"; }
    std::string operator()(const std::vector<double>& list) const {
      return fmt::format("a list of {} number{}", list.size(), list.size() == 1 ? "" : "s");
    }
    std::string operator()(const NumberRows& rows) const {
      return fmt::format("{} row{} of numbers", rows.size(), rows.size() == 1 ? "" : "s");
    }
    std::string operator()(const Table&) const { return "a table"; }
    std::string operator()(const TableList&) const { return "a list of tables"; }
    std::string operator()(const Unusable& unusable) const { return unusable.what; }
  };
  return std::visit(Words{}, value);
}

std::string to_toml(const Value& value) {
  struct Text {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const {
      const std::string digits = fmt::format("{}", number); // the shortest that gives the same bits back
      return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
    }
    std::string operator()(const std::string& text) const { return quoted(text); }
    std::string operator()(const std::vector<double>& list) const {
      std::vector<std::string> elements;
      for (const double number : list)
        elements.push_back((*this)(number));
      return fmt::format("[{}]", fmt::join(elements, ", "));
    }
    std::string operator()(const NumberRows& rows) const {
      std::vector<std::string> lists;
      for (const std::vector<double>& row : rows)
        lists.push_back((*this)(row));
      return fmt::format("[{}]", fmt::join(lists, ", "));
    }
    std::string operator()(const Table&) const { return "a table"; }
    std::string operator()(const TableList&) const { return "a list of tables"; }
    std::string operator()(const Unusable& unusable) const { return unusable.what; }
  };
  return std::visit(Text{}, value);
}

} // namespace keeler
