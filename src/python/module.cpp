// The compiled part of the Python package `keeler`. It is thin: the package in src/python/keeler has the interface and
// the docstrings.
#include "bindings.hpp"
#include "computing.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/version.hpp>

#include <new>

namespace py = pybind11;

namespace keeler::python {
namespace {

PyObject* raised_for(ExitCode code, const py::module_& errors) {
  const char* name = code == ExitCode::usage          ? "UsageError"
                     : code == ExitCode::invariant    ? "InvariantError"
                     : code == ExitCode::input_output ? "IoError"
                                                      : "RunError";
  return errors.attr(name).ptr();
}

} // namespace

// Translates exceptions to the Python classes of keeler/errors.py.
void bind_errors(py::module_&) {
  py::register_exception_translator(
      [](std::exception_ptr pointer) { // NOLINT(performance-unnecessary-value-param): its type
        if (!pointer)
          return;
        try {
          std::rethrow_exception(pointer);
        } catch (const py::error_already_set&) { // this and the next one are Python's
          throw;
        } catch (const py::builtin_exception&) {
          throw;
        } catch (const std::bad_alloc&) {
          PyErr_SetString(PyExc_MemoryError, no_memory);
        } catch (...) {
          const Error error = error_at_hand();
          PyErr_SetString(raised_for(error.code(), py::module_::import("keeler.errors")),
                          printable_line(error.what()).c_str());
        }
      });
}

} // namespace keeler::python

PYBIND11_MODULE(_core, module) {
  using namespace keeler;
  module.def("version", &program_version);
  module.def("threads", &threads);
  module.def("end_other_threads", &python::end_other_threads);
  module.def("set_threads", &set_threads, py::arg("count"));
  python::bind_errors(module);
  python::bind_scene(module);
  python::bind_snapshot(module);
  python::bind_simulation(module);
  python::bind_run(module);
  python::bind_own_forces(module);
  python::bind_own_physics(module);
  python::bind_light(module);
}
