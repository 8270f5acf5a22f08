// Conversion between Keeler's numbers and numpy arrays.
#pragma once

#include <keeler/core/vector.hpp>

#include <pybind11/numpy.h>

#include <cassert>
#include <span>
#include <string>
#include <vector>

namespace keeler::python {

namespace py = pybind11;

/// Returns a read-only array on memory that `owner` keeps alive. Strides are in bytes.
/// Precondition: `shape` and `strides` have equal lengths.
template<class T>
py::array view(const T* first, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  assert(shape.size() == strides.size());
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Return read-only arrays on lists of numbers, and on lists of vectors as rows of three.
template<class T> py::array view(const std::vector<T>& values, py::handle owner) {
  return view(values.data(), {static_cast<py::ssize_t>(values.size())}, {sizeof(T)}, owner);
}
py::array view(const std::vector<Vec3>& rows, py::handle owner);

/// Returns the rows times `factor` as a new read-only array. Precondition: `factor` is finite.
py::array scaled_copy(std::span<const Vec3> rows, double factor);

/// Makes an array read-only.
py::array sealed(py::array array);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Return an array of `count` rows of three as vectors, or of `count` numbers (or one for all). Throw UsageError, with
/// `name`, for another shape.
std::vector<Vec3> vectors_from(const Doubles& array, std::size_t count, const std::string& name, double factor = 1.0);
std::vector<double> numbers_from(const Doubles& array, std::size_t count, const std::string& name);

} // namespace keeler::python
