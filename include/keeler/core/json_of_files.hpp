// JSON as it is written, and as files of others hold it. Json is a type of the library nlohmann_json.
#pragma once

#include <keeler/core/error.hpp>

#include <filesystem>
#include <string>

namespace keeler {

/// Returns the text of JSON. Names of files may be no UTF-8, which JSON must be: what is none becomes U+FFFD.
template<class Json> std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Returns the JSON of a text that a file holds: discarded where it is none, or nests deeper than anything that Keeler
/// writes. What copies or prints JSON recurses.
template<class Json> Json json_of(const std::string& text) {
  constexpr int deepest = 32;
  bool is_too_deep = false;
  const auto note_depth = [&](int depth, typename Json::parse_event_t, const Json&) {
    is_too_deep = is_too_deep || depth > deepest;
    return !is_too_deep;
  };
  Json json = Json::parse(text, note_depth, false);
  return is_too_deep ? Json(Json::value_t::discarded) : json;
}

/// Returns what `use` makes of JSON that was read from a file or the files of a folder. Throws IoError naming `path`
/// where it does not have the entries, or the types of values, that Keeler writes.
template<class Json, class Use> auto using_json_of(const std::filesystem::path& path, const Use& use) {
  try {
    return use();
  } catch (const typename Json::exception&) {
    throw IoError("'" + path.string() +
                  "' holds something else than Keeler writes there (values of another type, or "
                  "none, in its JSON); restore it, or make it again");
  }
}

} // namespace keeler
