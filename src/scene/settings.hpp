// The values in force: what a checked document says, and defaults for the rest.
#pragma once

#include "document.hpp"

#include <cstdint>
#include <string>

namespace keeler {

class Settings {
public:
  /// The document has passed check_document.
  explicit Settings(Document document);

  bool has(const std::string& path) const { return find_entry(document_, path) != nullptr; }
  double number(const std::string& path) const;
  std::int64_t integer(const std::string& path) const;
  std::string text(const std::string& path) const;
  std::vector<double> numbers(const std::string& path) const;

  /// Whether the scene says it: it is no default.
  bool given(const std::string& path) const { return place(path) != default_place; }

  /// Where the value (or a table's header) stands, for messages.
  std::string place(const std::string& path) const { return find_entry(document_, path)->value_place; }

  /// The absolute path of the file that a key names: what a scene file says is relative to it, what the command line
  /// says to the current directory. The resolved scene holds the absolute path.
  std::string file_path(const std::string& key, const std::string& scene_name);

  /// Fills in what was derived, so that the resolved scene has it; `replaced` is the key that led to it.
  void resolve(const std::string& path, Value value, const std::string& replaced = {});

  /// The scene as TOML: every key in force, in the order of the key table. It reads back to the same scene.
  std::string resolved() const;

private:
  static constexpr const char* default_place = "default";
  Document document_;
};

} // namespace keeler
