#include "json_of_files.hpp"

#include <nlohmann/json.hpp>

namespace keeler {

template<class Json> std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

template<class Json> Json json_of(const std::string& text) {
  constexpr int max_depth = 32;
  bool is_too_deep = false;
  const auto note_depth = [&](int depth, typename Json::parse_event_t, const Json&) {
    is_too_deep = is_too_deep || depth > max_depth;
    return !is_too_deep;
  };
  Json json = Json::parse(text, note_depth, false);
  return is_too_deep ? Json(Json::value_t::discarded) : json;
}

template std::string json_text(const nlohmann::json&, int);
template std::string json_text(const nlohmann::ordered_json&, int);
template nlohmann::json json_of(const std::string&);
template nlohmann::ordered_json json_of(const std::string&);

} // namespace keeler
