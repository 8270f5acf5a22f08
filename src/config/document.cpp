#include <keeler/config/document.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/toml_bounds.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

namespace keeler::config {
namespace {

struct Positioned {
  toml::source_position position;
  DocumentEntry entry;
};

std::string in_quotes(std::string_view text) {
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

std::string location_of(const std::string& name, const toml::source_position& position) {
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

DocumentValue value_of_array(const toml::array& array) {
  if (const std::optional<std::vector<double>> numbers = numbers_in(array))
    return *numbers;
  if (const std::optional<NumberRows> rows = rows_in(array))
    return *rows;
  if (array.is_array_of_tables())
    return TomlTableList{array.size()};
  return Unusable{"a list of things that are not numbers"};
}

DocumentValue value_of(const toml::node& node) {
  switch (node.type()) {
  case toml::node_type::table:
    return TomlTable{};
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

// Returns 1e9 as an integer for a key that takes one.
DocumentValue as_whole_number(DocumentValue value, const std::string& path, const Schema& schema) {
  constexpr double end = 0x1p63;
  const auto* const number = std::get_if<double>(&value);
  if (!number || *number != std::trunc(*number) || !(std::fabs(*number) < end))
    return value;
  const Key* const key = schema.find_key(path);
  return key && key->type == KeyType::integer ? DocumentValue(static_cast<std::int64_t>(*number)) : value;
}

// Fails if the document has the path of the entry: the one or the other is a former name.
void refuse_twice(const TomlDocument& document, const DocumentEntry& entry) {
  if (const DocumentEntry* const earlier = find_entry(document, entry.path))
    fail_at(entry.key_location, fmt::format("{} cannot be combined with {} (its present name); remove one of the two",
                                            entry.former.empty() ? earlier->former : entry.former, entry.path));
}

// Flattens the tables that the schema has, so that it bounds depth and length of paths.
class Flattening {
public:
  Flattening(const std::string& name, const Schema& schema) : name_(name), schema_(schema) {}

  void add_table(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table)
      add(prefix + (is_plain(key.str()) ? std::string(key.str()) : in_quotes(key.str())), key.source().begin, node);
  }

  void add(const std::string& written, const toml::source_position& position, const toml::node& node) {
    const std::string path = schema_.current_path(written);
    entries_.push_back(
        {position,
         {path, location(position), location(node.source().begin), as_whole_number(value_of(node), path, schema_)}});
    if (path != written)
      entries_.back().entry.former = written;
    const Section* const section = schema_.find_section(path);
    if (const toml::table* inner = node.as_table(); inner && section)
      add_table(*inner, path + ".");
    if (section && section->repeated && node.is_array_of_tables() && node.as_array()->size() <= section->max_count)
      add_list(*node.as_array(), path);
  }

  /// Returns the entries in the order of the file.
  TomlDocument document() && {
    std::stable_sort(entries_.begin(), entries_.end(), [](const Positioned& a, const Positioned& b) {
      return std::tie(a.position.line, a.position.column) < std::tie(b.position.line, b.position.column);
    });
    TomlDocument document(schema_);
    for (Positioned& positioned : entries_) {
      refuse_twice(document, positioned.entry);
      document.add(std::move(positioned.entry));
    }
    return document;
  }

private:
  std::string location(const toml::source_position& position) const { return location_of(name_, position); }

  void add_list(const toml::array& tables, const std::string& path) {
    for (std::size_t n = 0; n < tables.size(); ++n) {
      const toml::table& table = *tables[n].as_table();
      const std::string own = fmt::format("{}[{}]", path, n + 1), at = location(table.source().begin);
      entries_.push_back({table.source().begin, {own, at, at, TomlTable{}}});
      add_table(table, own + ".");
    }
  }

  const std::string& name_;
  const Schema& schema_;
  std::vector<Positioned> entries_;
};

toml::table parsed(const std::string& text, const std::string& name) {
  files::require_bounded_toml(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    fail_at(location_of(name, error.source().begin), files::toml_fault(error.description()));
  }
}

} // namespace

const DocumentEntry* TomlDocument::find(const std::string& path) const {
  const auto found = positions_.find(path);
  return found == positions_.end() ? nullptr : &entries_[found->second];
}

void TomlDocument::add(DocumentEntry entry) {
  [[maybe_unused]] const bool is_new = positions_.emplace(entry.path, entries_.size()).second;
  assert(is_new);
  entries_.push_back(std::move(entry));
}

void TomlDocument::number() {
  positions_.clear();
  for (const DocumentEntry& entry : entries_)
    positions_.emplace(entry.path, positions_.size());
}

std::vector<std::string> tables_of(const TomlDocument& document, const std::string& section) {
  const DocumentEntry* const entry = find_entry(document, section);
  if (!entry)
    return {};
  const auto* const list = std::get_if<TomlTableList>(&entry->value);
  std::vector<std::string> tables;
  for (std::size_t n = 1; list && n <= list->count; ++n)
    tables.push_back(fmt::format("{}[{}]", section, n));
  return list ? tables : std::vector{section};
}

TomlDocument parse_document(const std::string& text, const std::string& name, const Schema& schema) {
  const toml::table table = parsed(text, name);
  Flattening flattening(name, schema);
  flattening.add_table(table, "");
  return std::move(flattening).document();
}

namespace {

// Returns the word, or for a key that takes a number the number that it spells where TOML does not read one: 2^64, .5,
// 1e400.
DocumentValue value_of_word(const std::string& word, const std::string& path, const Schema& schema) {
  const Key* const key = schema.find_key(path);
  if (!key || (key->type != KeyType::number && key->type != KeyType::integer))
    return word;
  const std::string_view digits = std::string_view(word).substr(word.starts_with('+') ? 1 : 0);
  double number = 0.0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (end != digits.data() + digits.size() || fault == std::errc::invalid_argument)
    return word;
  if (fault == std::errc::result_out_of_range)
    return Unusable{"a number too large or too small to compute with"};
  return as_whole_number(number, path, schema);
}

} // namespace

std::vector<DocumentEntry> parse_override_value(const std::string& text, const std::string& path,
                                                const std::string& key_location, const std::string& value_location,
                                                const Schema& schema) {
  const std::string current = schema.current_path(path);
  const std::vector<DocumentEntry> word = {
      {current, key_location, value_location, value_of_word(text, current, schema), true, current == path ? "" : path}};
  const std::string line = "value = " + text;
  if (const std::optional<files::TomlExcess> excess = files::toml_excess(line)) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin != text.npos && (text[begin] == '[' || text[begin] == '{'))
      fail_at(value_location, excess->what);
    return word; // such as ../../a.hdf
  }
  std::vector<DocumentEntry> entries;
  try {
    const toml::table table = toml::parse(line);
    if (table.size() != 1)
      return word; // a line break in the text: more than one value
    Flattening flattening(value_location, schema);
    flattening.add(path, {}, *table.get("value"));
    for (const DocumentEntry& entry : std::move(flattening).document())
      entries.push_back({entry.path, entry.path == current ? key_location : value_location, value_location, entry.value,
                         true, entry.former});
  } catch (const toml::parse_error&) {
    return word;
  }
  assert(!entries.empty());
  return entries;
}

std::vector<std::string> former_name_notices(const TomlDocument& document) {
  std::vector<std::string> notices;
  std::set<std::string> named;
  for (const DocumentEntry& entry : document)
    if (!entry.former.empty() && named.insert(declared_path(entry.former)).second)
      notices.push_back(fmt::format("{}: '{}' is now called '{}'", entry.key_location, declared_path(entry.former),
                                    declared_path(entry.path)));
  return notices;
}

void fail_at(const std::string& location, const std::string& message) {
  throw UsageError(location + ": " + message);
}

std::string kind_words(const DocumentValue& value) {
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
    std::string operator()(const TomlTable&) const { return "a table"; }
    std::string operator()(const TomlTableList&) const { return "a list of tables"; }
    std::string operator()(const Unusable& unusable) const { return unusable.what; }
  };
  return std::visit(Words{}, value);
}

std::string to_toml(const DocumentValue& value) {
  struct Text {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const {
      const std::string digits = fmt::format("{}", number); // the shortest that reads back to the same bits
      return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
    }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
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
    std::string operator()(const TomlTable&) const { return "a table"; }
    std::string operator()(const TomlTableList&) const { return "a list of tables"; }
    std::string operator()(const Unusable& unusable) const { return unusable.what; }
  };
  return std::visit(Text{}, value);
}

} // namespace keeler::config
