// Python bindings of photometry.
#include "bindings.hpp"
#include "computing.hpp"
#include "numbers.hpp"
#include "snapshot.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/light/photometry.hpp>
#include <keeler/light/photometry_record.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/measured_part.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::python {
namespace {

namespace fs = std::filesystem;

// The angles of a grid, in degrees.
struct Angles {
  std::vector<double> elevations, sun_elevations, phases, azimuths;
};

std::vector<light::Sight> sights_of(Angles angles) {
  for (std::vector<double>* const list : {&angles.elevations, &angles.sun_elevations, &angles.phases, &angles.azimuths})
    for (double& angle : *list)
      angle *= pi / 180.0;
  return light::sight_grid(angles.elevations, angles.sun_elevations, angles.phases, angles.azimuths);
}

// A text names a law; a function of the phase angle in rad is a phase function. Called with the interpreter's lock.
light::SharedLaw law_of(const py::object& law, double albedo) {
  if (py::isinstance<py::str>(law))
    return light::law_named(law.cast<std::string>(), albedo);
  light::law_named("isotropic", albedo); // checks the albedo
  const auto value = [&law](double phase) {
    const py::object returned = law(phase);
    try {
      return returned.cast<double>();
    } catch (const py::cast_error&) {
      throw UsageError(
          fmt::format("the phase function returns {} at the phase angle {:g} rad; it must be a number from 0 on",
                      py::repr(returned).cast<std::string>(), phase));
    }
  };
  return light::particle_law(value, albedo);
}

py::list photometry(const py::object& what, const std::optional<double>& since, const std::optional<double>& until,
                    const Angles& angles, const py::object& law, double albedo, std::uint64_t rays,
                    const std::optional<double>& error, std::uint64_t seed) {
  light::PhotometrySettings settings;
  settings.law = law_of(law, albedo);
  settings.rays = rays;
  settings.error = error;
  settings.seed = seed;
  const std::vector<light::Sight> sights = sights_of(angles);
  const bool in_memory = py::isinstance<PythonSnapshot>(what);
  const PythonSnapshot* const snapshot = in_memory ? &what.cast<const PythonSnapshot&>() : nullptr;
  const fs::path path = in_memory ? fs::path() : what.cast<fs::path>();
  const std::vector<light::Photometry> found = make_interruptibly([&] {
    std::vector<light::Photometry> all;
    if (snapshot)
      all = light::photometry({&snapshot->patch, 1}, sights, settings);
    else
      all = light::photometry(runs::measured_part(path, {since, until}).stored.patches, sights, settings);
    throw_if_interrupted();
    return all;
  });
  py::list numbers;
  for (const light::Photometry& one : found) {
    const quantities::Record record = record_of(one);
    numbers.append(py::make_tuple(as_python(json_of(record)), described(quantities_of(record))));
  }
  return numbers;
}

} // namespace

void bind_light(py::module_& module) {
  module.def("can_trace", &light::can_trace);
  module.def(
      "photometry",
      [](const py::object& what, const std::optional<double>& since, const std::optional<double>& until,
         const std::vector<double>& elevations, const std::vector<double>& sun_elevations,
         const std::vector<double>& phases, const std::vector<double>& azimuths, const py::object& law, double albedo,
         std::uint64_t rays, const std::optional<double>& error, std::uint64_t seed) {
        return photometry(what, since, until, {elevations, sun_elevations, phases, azimuths}, law, albedo, rays, error,
                          seed);
      },
      py::arg("what"), py::arg("since"), py::arg("until"), py::arg("elevations"), py::arg("sun_elevations"),
      py::arg("phases"), py::arg("azimuths"), py::arg("law"), py::arg("albedo"), py::arg("rays"), py::arg("error"),
      py::arg("seed"));
}

} // namespace keeler::python
