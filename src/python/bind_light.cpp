// Python bindings of photometry and occultations.
#include "bindings.hpp"
#include "computing.hpp"
#include "numbers.hpp"
#include "snapshot.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/light/occultation_record.hpp>
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

// Returns what a function of Python returned as a number.
double number_from(const py::object& returned, const std::string& what) {
  try {
    return returned.cast<double>();
  } catch (const py::cast_error&) {
    throw UsageError(
        fmt::format("{} returns {}; it must return a number from 0 on", what, py::repr(returned).cast<std::string>()));
  }
}

// A text names a law; a function of the phase angle in rad is a phase function, and of two cosines and the phase angle,
// where `is_surface`, the I/F of a surface. Called with the interpreter's lock.
light::SharedLaw law_of(const py::object& law, bool is_surface, double albedo) {
  if (py::isinstance<py::str>(law))
    return light::law_named(law.cast<std::string>(), albedo);
  light::law_named("isotropic", albedo); // checks the albedo
  if (is_surface)
    return light::surface_law(
        [&law](double in, double out, double phase) { return number_from(law(in, out, phase), "the surface law"); },
        albedo);
  return light::particle_law([&law](double phase) { return number_from(law(phase), "the phase function"); }, albedo);
}

// What is looked at: a snapshot in memory, or the part of a run's folder between two orbits.
class Looked {
public:
  Looked(const py::object& what, const std::optional<double>& since, const std::optional<double>& until)
      : window_{since, until} {
    if (py::isinstance<PythonSnapshot>(what))
      snapshot_ = &what.cast<const PythonSnapshot&>();
    else
      path_ = what.cast<fs::path>();
  }

  // Calls measure(patches), from which Ctrl-C returns.
  template<class Measure> auto measured(const Measure& measure) const {
    return make_interruptibly([&] {
      auto all = snapshot_ ? measure(std::span(&snapshot_->patch, 1))
                           : measure(std::span<const Patch>(runs::measured_part(path_, window_).stored.patches));
      throw_if_interrupted();
      return all;
    });
  }

private:
  const PythonSnapshot* snapshot_ = nullptr;
  fs::path path_;
  runs::OrbitWindow window_;
};

// A record as a dictionary, and what is said of its numbers.
template<class Numbers> py::tuple as_numbers(const Numbers& numbers) {
  const quantities::Record record = record_of(numbers);
  return py::make_tuple(as_python(json_of(record)), described(quantities_of(record)));
}

// Returns the numbers of each sight, and those of each set of azimuths.
py::tuple photometry(const Looked& what, const Angles& angles, const light::PhotometrySettings& settings) {
  const std::vector<light::Sight> sights = sights_of(angles);
  const std::vector<light::Photometry> found =
      what.measured([&](std::span<const Patch> patches) { return light::photometry(patches, sights, settings); });
  py::list numbers, groups;
  for (const light::Photometry& one : found)
    numbers.append(as_numbers(one));
  for (const light::AzimuthGroup& group : light::azimuth_groups(found))
    groups.append(as_numbers(group));
  return py::make_tuple(numbers, groups);
}

// Returns the numbers of each line of sight, with the autocovariance beside them, and those of the fit, or none.
py::tuple occultation(const Looked& what, const std::vector<double>& elevations, const std::vector<double>& azimuths,
                      const light::FootprintTrack& track, light::BarSection section) {
  std::vector<light::Bearing> stars;
  for (const double elevation : elevations)
    for (const double azimuth : azimuths)
      stars.push_back({elevation * (pi / 180.0), azimuth * (pi / 180.0)});
  const std::vector<light::FootprintStatistics> found =
      what.measured([&](std::span<const Patch> patches) { return light::footprint_statistics(patches, stars, track); });
  py::list numbers;
  for (const light::FootprintStatistics& one : found) {
    const py::tuple values = as_numbers(one);
    values[0]["autocovariance"] = one.autocovariance;
    numbers.append(values);
  }
  const std::optional<light::FittedWakes> fit = fit_wakes(found, section);
  return py::make_tuple(numbers, fit ? py::object(as_numbers(*fit)) : py::none());
}

} // namespace

void bind_light(py::module_& module) {
  module.def("can_trace", &light::can_trace);
  module.def(
      "photometry",
      [](const py::object& what, const std::optional<double>& since, const std::optional<double>& until,
         const std::vector<double>& elevations, const std::vector<double>& sun_elevations,
         const std::vector<double>& phases, const std::vector<double>& azimuths, const py::object& law, bool is_surface,
         double albedo, std::uint64_t rays, const std::optional<double>& error, std::uint64_t seed) {
        light::PhotometrySettings settings;
        settings.law = law_of(law, is_surface, albedo);
        settings.rays = rays;
        settings.error = error;
        settings.seed = seed;
        return photometry({what, since, until}, {elevations, sun_elevations, phases, azimuths}, settings);
      },
      py::arg("what"), py::arg("since"), py::arg("until"), py::arg("elevations"), py::arg("sun_elevations"),
      py::arg("phases"), py::arg("azimuths"), py::arg("law"), py::arg("is_surface"), py::arg("albedo"), py::arg("rays"),
      py::arg("error"), py::arg("seed"));
  module.def(
      "occultation",
      [](const py::object& what, const std::optional<double>& since, const std::optional<double>& until,
         const std::vector<double>& elevations, const std::vector<double>& azimuths, double length, double width,
         double track, std::size_t tracks, std::size_t samples, std::size_t rays, bool ellipse) {
        return occultation({what, since, until}, elevations, azimuths,
                           {.length = length,
                            .width = width,
                            .azimuth = track * (pi / 180.0),
                            .tracks = tracks,
                            .samples = samples,
                            .rays = rays},
                           ellipse ? light::BarSection::ellipse : light::BarSection::rectangle);
      },
      py::arg("what"), py::arg("since"), py::arg("until"), py::arg("elevations"), py::arg("azimuths"),
      py::arg("length"), py::arg("width"), py::arg("track"), py::arg("tracks"), py::arg("samples"), py::arg("rays"),
      py::arg("ellipse"));
}

} // namespace keeler::python
