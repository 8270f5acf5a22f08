#include "own_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <mutex>

namespace keeler::python {

KeptObject::KeptObject(py::object object)
    : object_(new py::object(std::move(object)), [](py::object* last) {
        if (!Py_IsInitialized())
          return;
        const py::gil_scoped_acquire lock;
        delete last;
      }) {}

const char* kept_text(const std::string& text) {
  static std::mutex guard;
  static std::deque<std::string>& texts = *new std::deque<std::string>; // registries may outlive other static variables
  const std::lock_guard lock(guard);
  if (const auto known = std::find(texts.begin(), texts.end(), text); known != texts.end())
    return known->c_str();
  return texts.emplace_back(text).c_str();
}

std::vector<Key> keys_from(const py::list& declared) {
  std::vector<Key> keys;
  for (const py::handle entry : declared) {
    const auto key = entry.cast<py::tuple>();
    const bool required = key[1].is_none();
    keys.push_back({.path = key[0].cast<std::string>(),
                    .type = KeyType::number,
                    .fallback = required ? "" : fmt::format("{}", key[1].cast<double>()),
                    .example = required ? "1.0" : "",
                    .unit = key[2].cast<std::string>(),
                    .meaning = key[3].cast<std::string>(),
                    .range = {.low = key[4].cast<double>(), .high = key[5].cast<double>()}});
  }
  return keys;
}

py::dict values_of(const std::vector<Key>& keys, const Parameters& parameters) {
  py::dict values;
  for (const Key& key : keys)
    if (key.type == KeyType::number)
      values[py::str(key.path)] = parameters.number(key.path);
  return values;
}

} // namespace keeler::python
