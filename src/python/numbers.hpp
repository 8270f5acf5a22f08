// Numbers with names as Python's own objects.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <nlohmann/json.hpp>
#include <pybind11/pybind11.h>

#include <span>

namespace keeler::python {

namespace py = pybind11;

/// Dictionaries, lists, numbers, texts and None.
py::object as_python(const nlohmann::ordered_json& json);

/// A dictionary: a full name, and (unit, meaning, name of what stands beside the number in SI or None, name of that
/// number).
py::dict described(std::span<const Quantity> quantities);

} // namespace keeler::python
