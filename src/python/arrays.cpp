#include "arrays.hpp"

#include "computing.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::python {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

} // namespace

py::array view(const std::vector<Vec3>& rows, py::handle owner) {
  return view(reinterpret_cast<const double*>(rows.data()), {static_cast<py::ssize_t>(rows.size()), 3},
              {sizeof(Vec3), sizeof(double)}, owner);
}

py::array sealed(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array scaled_copy(std::span<const Vec3> rows, double factor) {
  assert(std::isfinite(factor));
  require_own_threads();
  py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  double* const out = array.mutable_data();
  parallel_for(rows.size(), [&](std::size_t k) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[3 * k + axis] = rows[k][static_cast<Eigen::Index>(axis)] * factor;
  });
  return sealed(std::move(array));
}

std::vector<Vec3> vectors_from(const Doubles& array, std::size_t count, const std::string& name, double factor) {
  if (array.ndim() != 2 || static_cast<std::size_t>(array.shape(0)) != count || array.shape(1) != 3)
    throw UsageError(fmt::format("{} has the shape {}; give one row of x, y, z per particle, ({}, 3)", name,
                                 shape_of(array), count));
  std::vector<Vec3> rows(count);
  const double* const in = array.data();
  for (std::size_t k = 0; k < count; ++k)
    rows[k] = factor * Vec3(in[3 * k], in[3 * k + 1], in[3 * k + 2]);
  return rows;
}

std::vector<double> numbers_from(const Doubles& array, std::size_t count, const std::string& name) {
  if (array.ndim() == 0) // one number for all particles
    return std::vector<double>(count, array.data()[0]);
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != count)
    throw UsageError(fmt::format("{} has the shape {}; give one number per particle, ({},), or one for all", name,
                                 shape_of(array), count));
  return {array.data(), array.data() + count};
}

} // namespace keeler::python
