// Python bindings of scenes and of user-defined restitution laws.
#include "bindings.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/collision/restitution.hpp>
#include <keeler/scene/examples.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace py = pybind11;

namespace keeler::python {
namespace {

using CFunction = double (*)(double speed, double radius_low, double radius_high);

void add_c_function(const std::string& name, std::uintptr_t address) {
  assert(address != 0);
  const auto function = reinterpret_cast<CFunction>(address); // NOLINT(performance-no-int-to-ptr): ctypes gives numbers
  collision::add_own_restitution(
      name, [function](const Impact& impact) { return function(impact.speed, impact.radius_low, impact.radius_high); });
}

std::vector<std::string> remarks(const Scene& scene) {
  std::vector<std::string> lines = scene.notices;
  for (const std::string& warning : advice::warnings(scene))
    lines.push_back(warning);
  return lines;
}

} // namespace

void bind_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def(py::init([](const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                       const std::optional<std::string>& from) { return parse_scene(text, name, overrides, from); }),
           py::arg("text"), py::arg("name"), py::arg("overrides"), py::arg("start_from") = py::none())
      .def_readonly("text", &Scene::resolved)
      .def_readonly("title", &Scene::title)
      .def_property_readonly("remarks", &remarks)
      .def_property_readonly("orbital_frequency", [](const Scene& scene) { return scene.planet.orbital_frequency; })
      .def_property_readonly("tick", [](const Scene& scene) { return scene.time.step; })
      .def_property_readonly("kick_interval", &Scene::kick_interval)
      .def_property_readonly(
          "end", [](const Scene& scene) { return static_cast<double>(scene.time.end_step) * scene.time.step; });
  module.def("is_example", [](const std::string& name) {
    const std::vector<scene::ExampleScene>& all = scene::example_scenes();
    return std::any_of(all.begin(), all.end(), [&](const scene::ExampleScene& one) { return one.name == name; });
  });
  module.def("example_text", [](const std::string& name) { return std::string(scene::find_example(name).toml); });
  module.def("stored_scene", &scene::parse_stored_scene, py::arg("text"), py::arg("name"));
  module.def("add_restitution_law", &add_c_function, py::arg("name"), py::arg("address"));
}

} // namespace keeler::python
