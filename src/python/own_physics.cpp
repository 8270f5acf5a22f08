// Size laws, starts, columns of series.csv and quantities of `analyze` that Python registers.
#include "arrays.hpp"
#include "bindings.hpp"
#include "own_parts.hpp"
#include "snapshot.hpp"

#include <keeler/core/error.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/runs/own_numbers.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

namespace keeler::python {
namespace {

constexpr std::size_t intervals = 4096; // of a size law's quantiles

// Returns ∫ r^k du over an interval in which r is linear, per length of it: Σ a^i b^(k−i) / (k + 1).
double mean_power_between(double a, double b, int k) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i)
    sum += std::pow(a, i) * std::pow(b, k - i);
  return sum / (k + 1);
}

// Makes a law that is linear between the radii at equally spaced quantiles.
particles::SizeLaw law_between(const std::string& name, std::vector<double> radii) {
  for (std::size_t k = 0; k < radii.size(); ++k)
    if (!(std::isfinite(radii[k]) && radii[k] > 0.0) || (k > 0 && radii[k] < radii[k - 1]))
      throw UsageError(
          fmt::format("the size law '{}' gives the radius {:g} m at the quantile {:g} (radii are above 0 and "
                      "rise with the quantile); correct its function",
                      name, radii[k], static_cast<double>(k) / intervals));
  const auto nodes = std::make_shared<const std::vector<double>>(std::move(radii));
  particles::SizeLaw law{nodes->front(), nodes->back(), 0, {}, {}};
  law.mean_power = [nodes](int k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < intervals; ++i)
      sum += mean_power_between((*nodes)[i], (*nodes)[i + 1], k) / intervals;
    return sum;
  };
  law.radius = [nodes](double u, std::size_t) {
    const double at = u * intervals;
    const std::size_t i = std::min(static_cast<std::size_t>(at), intervals - 1);
    const double within = at - static_cast<double>(i);
    return (1.0 - within) * (*nodes)[i] + within * (*nodes)[i + 1];
  };
  return law;
}

void add_python_size_law(const std::string& name, py::object quantile, const py::list& declared) {
  const std::vector<Key> keys = keys_from(declared);
  particles::add_size_law(
      {kept_text(name), keys,
       [name, keys, function = KeptObject(std::move(quantile))](const Parameters& p) {
         const py::gil_scoped_acquire lock;
         py::array_t<double> u(intervals + 1);
         for (std::size_t k = 0; k <= intervals; ++k)
           u.mutable_data()[k] = static_cast<double>(k) / intervals;
         const auto radii = (*function)(sealed(std::move(u)), values_of(keys, p)).cast<Doubles>();
         return law_between(name,
                            numbers_from(radii, intervals + 1, fmt::format("what the size law '{}' returns", name)));
       }},
      IfTaken::replace);
}

py::array copy_of(std::span<const double> values) {
  return sealed(py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data()));
}

void add_python_start(const std::string& name, py::object place, const py::list& declared) {
  const std::vector<Key> keys = keys_from(declared);
  particles::add_start(
      {kept_text(name), keys,
       [name, keys, function = KeptObject(std::move(place))](const Parameters& p,
                                                             const particles::StartRequest& request) {
         const py::gil_scoped_acquire lock;
         const double omega = request.orbital_frequency;
         const auto states =
             (*function)(copy_of(request.radii), copy_of(request.masses),
                         std::pair(request.box.size_x, request.box.size_y), omega, request.frequencies.kappa,
                         request.frequencies.nu, omega * request.velocity_dispersion, request.seed, values_of(keys, p))
                 .cast<std::pair<Doubles, Doubles>>();
         const std::size_t count = request.radii.size();
         const std::vector<Vec3> positions = vectors_from(states.first, count,
                                                          fmt::format("the positions of the start '{}'", name)),
                                 velocities =
                                     vectors_from(states.second, count,
                                                  fmt::format("the velocities of the start '{}'", name), 1.0 / omega);
         std::vector<State> placed(count);
         for (std::size_t k = 0; k < count; ++k)
           placed[k] = {positions[k], velocities[k]};
         return placed;
       }},
      IfTaken::replace);
}

void add_python_column(const std::string& name, const std::string& unit, const std::string& plot,
                       const std::string& meaning, py::object function) {
  runs::add_series_column(
      {kept_text(name), kept_text(unit), kept_text(plot), kept_text(meaning),
       [function = KeptObject(std::move(function))](const Simulation& simulation, const Scene& scene) {
         const py::gil_scoped_acquire lock;
         return (*function)(PythonSnapshot{simulation.patch(), scene.resolved}).cast<double>();
       }},
      IfTaken::replace);
}

void add_python_quantity(const std::string& name, const std::string& unit, const std::string& label,
                         const std::string& meaning, py::object function) {
  runs::add_quantity({kept_text(name), kept_text(unit), kept_text(label), kept_text(meaning),
                      [function = KeptObject(std::move(function))](const Patch& patch) {
                        const py::gil_scoped_acquire lock;
                        return (*function)(PythonSnapshot{patch, ""}).cast<double>();
                      }},
                     IfTaken::replace);
}

} // namespace

void bind_own_physics(py::module_& module) {
  module.def("add_size_law", &add_python_size_law, py::arg("name"), py::arg("quantile"), py::arg("keys"));
  module.def("add_start", &add_python_start, py::arg("name"), py::arg("place"), py::arg("keys"));
  module.def("add_series_column", &add_python_column, py::arg("name"), py::arg("unit"), py::arg("plot"),
             py::arg("meaning"), py::arg("function"));
  module.def("add_quantity", &add_python_quantity, py::arg("name"), py::arg("unit"), py::arg("label"),
             py::arg("meaning"), py::arg("function"));
}

} // namespace keeler::python
