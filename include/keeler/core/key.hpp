// Settings by name. Whatever a user may choose (a restitution law, a size law, a force) declares its keys here once:
// name, type, unit, default, meaning, and whether it changes the physics. The scene file, its checks and suggestions,
// the manual's table and the state hash all read that declaration.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace keeler {

/// rows: a table of numbers, given in place or as the path of a text file.
enum class KeyType { text, path, choice, number, integer, pair, triple, rows };

/// What a key has a say in. The state hash covers the keys of the motion: what only shaped the start is in the state.
enum class KeyEffect { motion, start, output };

/// Allowed numbers; an open end is excluded.
struct KeyRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  bool contains(double value) const;
  /// "above 0", "from 0 to 1", …; empty when everything is allowed.
  std::string words() const;

  static KeyRange above(double low) { return {.low = low, .low_open = true}; }
  static KeyRange at_least(double low) { return {.low = low}; }
};

/// A key that has a meaning only when another one is given, and has one of `values` where there are any.
struct KeyCondition {
  std::string key;
  std::vector<std::string> values;

  bool allows(const std::string& value) const;
  /// " = "a" or "b"", or nothing.
  std::string words() const;
};

struct Key {
  std::string path{}; ///< "particles.sizes.radius"; in the declaration of a law or a force its own name, "radius"
  KeyType type = KeyType::text;
  std::string fallback{}; ///< the default as TOML; empty: the key is needed where its section and condition hold
  std::string example{};  ///< TOML, for messages, where there is no default
  std::string unit{};
  std::string meaning{};
  KeyRange range{};
  std::vector<std::string> choices{};      ///< of a choice; words that a number may be instead
  std::vector<std::string> alternatives{}; ///< exactly one of this key and these is given
  KeyCondition only_with{};
  std::vector<std::string> columns{}; ///< of rows: what each holds, with its unit
  KeyEffect effect = KeyEffect::motion;
  std::string unhashed{}; ///< TOML: with this value a scene has the state hash that it had before there was the key

  std::string section() const { return path.substr(0, path.rfind('.') == std::string::npos ? 0 : path.rfind('.')); }
  std::string name() const { return path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1); }
};

/// Each row as long as the key has columns.
using NumberRows = std::vector<std::vector<double>>;

/// The checked values of one table of the scene, by the names of its keys: what a law or a force is made from.
class Parameters {
public:
  using Value = std::variant<std::int64_t, double, std::string, std::vector<double>, NumberRows>;

  void set(const std::string& name, Value value) { values_[name] = std::move(value); }
  bool has(const std::string& name) const { return values_.count(name) > 0; }

  // The value of a key that is in force; a key asked for by a wrong name or type is a programmer's mistake.
  double number(const std::string& name) const { return std::get<double>(values_.at(name)); }
  std::int64_t integer(const std::string& name) const { return std::get<std::int64_t>(values_.at(name)); }
  const std::string& text(const std::string& name) const { return std::get<std::string>(values_.at(name)); }
  const std::vector<double>& numbers(const std::string& name) const {
    return std::get<std::vector<double>>(values_.at(name));
  }
  const NumberRows& rows(const std::string& name) const { return std::get<NumberRows>(values_.at(name)); }

private:
  std::map<std::string, Value> values_;
};

} // namespace keeler
