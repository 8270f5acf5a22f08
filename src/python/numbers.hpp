// Conversion of named numbers to Python objects.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <nlohmann/json.hpp>
#include <pybind11/pybind11.h>

#include <span>

namespace keeler::python {

namespace py = pybind11;

/// Converts JSON to dictionaries, lists, numbers, strings and None.
py::object as_python(const nlohmann::ordered_json& json);

/// Returns a dictionary from full names to (unit, meaning, name of the error or scatter in SI or None, name of the
/// number in SI).
py::dict described(std::span<const quantities::Quantity> quantities);

} // namespace keeler::python
