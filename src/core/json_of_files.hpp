// Writes and reads JSON, also files of unknown origin. Json is nlohmann::json or nlohmann::ordered_json: the library's
// parsers and writers are compiled for these two, once.
#pragma once

#include <keeler/core/error.hpp>

#include <filesystem>
#include <string>

namespace keeler {

/// Returns the text of JSON. Invalid UTF-8, which file names may contain, becomes U+FFFD.
template<class Json> std::string json_text(const Json& json, int indent = -1);

/// Parses a text. Returns a discarded value if it is not JSON, or nests deeper than any file of Keeler: code that
/// copies or prints JSON recurses.
template<class Json> Json json_of(const std::string& text);

/// Returns use(), which reads JSON from a file or the files of a folder. Throws IoError naming `path` if entries are
/// missing, or values have other types than Keeler writes.
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
