// Settings by name. Each component that a user can choose (a restitution law, a size law, a force) declares its keys
// once: name, type, unit, default, meaning, and effect on the physics. The scene file, its checks and suggestions, the
// manual's table and the state hash all use that declaration.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace keeler {

/// rows: a table of numbers, given in the scene or as the path of a text file.
enum class KeyType { text, path, choice, number, integer, pair, triple, rows };

/// What a key affects. The state hash covers keys of `motion`; keys of `start` affect only the initial state.
enum class KeyEffect { motion, start, output };

/// What becomes of an addition with a name that the calling program has given before: a program that runs the same
/// lines again, such as a cell of a notebook, replaces. Scenes that were read before keep what they were read with.
enum class IfTaken { refuse, replace };

/// Interval of allowed numbers; an open end is excluded.
struct KeyRange {
  double low = -std::numeric_limits<double>::infinity(); ///< lower end
  double high = std::numeric_limits<double>::infinity(); ///< upper end
  bool low_open = false;                                 ///< excludes the lower end
  bool high_open = false;                                ///< excludes the upper end

  bool contains(double value) const; ///< true if the value is allowed
  /// Describes the interval for messages: "above 0", "from 0 to 1", …; empty when everything is allowed.
  std::string words() const;

  static KeyRange above(double low) { return {.low = low, .low_open = true}; } ///< numbers > low
  static KeyRange at_least(double low) { return {.low = low}; }                ///< numbers ≥ low
};

/// Condition of a key: it applies only when `key` is given, with one of `values` if there are any.
struct KeyCondition {
  std::string key;                 ///< path of the other key; empty: no condition
  std::vector<std::string> values; ///< words, any of which it needs; empty: any value

  /// True if `value` is one of `values`.
  bool allows(const std::string& value) const;
  /// Returns ` = "a" or "b"`; empty without values.
  std::string words() const;
};

/// The declaration of a key.
struct Key {
  std::string path{};           ///< "particles.sizes.radius"; in the declaration of a law or a force only "radius"
  KeyType type = KeyType::text; ///< type of its value
  std::string fallback{}; ///< the default as TOML; empty: the key is required when its section and condition apply
  std::string example{};  ///< TOML, for messages about keys without a default
  std::string unit{};     ///< of its value, for people; "1" for a pure number; empty for words
  std::string meaning{};  ///< a line for the manual and for messages
  KeyRange range{};       ///< of its numbers
  std::vector<std::string> choices{};      ///< of a choice; for a number, words that are accepted instead
  std::vector<std::string> alternatives{}; ///< exactly one of this key and these is given
  KeyCondition only_with{};                ///< when the key applies
  std::vector<std::string> columns{};      ///< of rows: meaning and unit of each column
  KeyEffect effect = KeyEffect::motion;    ///< what the key affects
  std::string former_name{}; ///< an earlier name(), which documents may still use; the state hash keeps it
  std::string unhashed{};    ///< TOML; this value is not hashed: scenes older than the key keep their state hash

  /// Returns the path without its last part: "particles.sizes"; empty if it has one part.
  std::string section() const { return path.substr(0, path.rfind('.') == std::string::npos ? 0 : path.rfind('.')); }
  /// Returns the last part of the path: "radius".
  std::string name() const { return path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1); }
};

/// A table; each row has one number per column of its key.
using NumberRows = std::vector<std::vector<double>>;

/// The checked values of one table of the scene, by key name, from which a law or a force is made.
class Parameters {
public:
  using Value = std::variant<std::int64_t, double, std::string, std::vector<double>, NumberRows>; ///< of one key

  void set(const std::string& name, Value value) { values_[name] = std::move(value); } ///< adds or replaces it
  bool has(const std::string& name) const { return values_.count(name) > 0; }          ///< true if the key has a value

  /// @{
  /// Returns the value of a key. Precondition: the key has a value, of this type.
  double number(const std::string& name) const { return std::get<double>(values_.at(name)); }
  std::int64_t integer(const std::string& name) const { return std::get<std::int64_t>(values_.at(name)); }
  const std::string& text(const std::string& name) const { return std::get<std::string>(values_.at(name)); }
  const std::vector<double>& numbers(const std::string& name) const {
    return std::get<std::vector<double>>(values_.at(name));
  }
  const NumberRows& rows(const std::string& name) const { return std::get<NumberRows>(values_.at(name)); }
  /// @}

private:
  std::map<std::string, Value> values_;
};

} // namespace keeler
