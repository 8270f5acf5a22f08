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
