// What all physics of one's own in Python needs: kept functions and names, and the keys of tables of a scene.
#pragma once

#include <keeler/core/key.hpp>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace keeler::python {

namespace py = pybind11;

/// An object of Python that C++ keeps: released with the interpreter's lock, wherever that is, and not at all after the
/// interpreter's end.
class KeptObject {
public:
  explicit KeptObject(py::object object);
  const py::object& operator*() const { return *object_; }

private:
  std::shared_ptr<py::object> object_;
};

/// Returns a text that is never freed: registries keep pointers to names.
const char* kept_text(const std::string& text);

/// Returns number keys from a list of (name, default or None, unit, meaning, low, high).
std::vector<Key> keys_from(const py::list& declared);

/// Returns the numbers of a table by their names, in the order of its keys.
py::dict values_of(const std::vector<Key>& keys, const Parameters& parameters);

} // namespace keeler::python
