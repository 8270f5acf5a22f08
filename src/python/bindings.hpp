// The functions that add the parts of the module.
#pragma once

#include <pybind11/pybind11.h>

namespace keeler::python {

void bind_errors(pybind11::module_& module);
void bind_light(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_snapshot(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_own_forces(pybind11::module_& module);
void bind_own_physics(pybind11::module_& module);

} // namespace keeler::python
