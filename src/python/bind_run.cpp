// Runs with a folder in this process: of scenes that only this process knows.
#include "bindings.hpp"
#include "computing.hpp"

#include <keeler/runs/run.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <functional>

namespace keeler::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;

// Calls go(options, requests) without the interpreter's lock. A first Ctrl-C stops the run with a checkpoint, a second
// one at the end of a step without.
void run_here(runs::RunOptions options, const std::function<void(const runs::RunOptions&, runs::RunRequests&)>& go) {
  require_own_threads();
  const Keyboard keyboard;
  runs::RunRequests requests;
  const auto look = [&] {
    if (keyboard.stop_flag())
      requests.stop = true;
    if (keyboard.give_up())
      requests.give_up = true;
  };
  options.start_progress = [&](const initial_conditions::StartProgress&) { look(); };
  options.progress = [&](const runs::RunProgress&) { look(); };
  try {
    const Unlocked unlocked;
    go(options, requests);
  } catch (const Error&) { // of a stop before the first state was made, or of giving up
    keyboard.deliver();
    raise_interrupts();
    throw;
  }
  keyboard.deliver();
  raise_interrupts();
}

void start(const Scene& scene, const fs::path& folder, bool force) {
  runs::RunOptions options;
  options.folder = folder;
  options.force = force;
  run_here(std::move(options),
           [&](const runs::RunOptions& all, runs::RunRequests& requests) { start_run(scene, all, requests); });
}

void go_on(const fs::path& folder, const std::optional<double>& until) {
  runs::RunOptions options;
  options.folder = folder;
  options.until_orbits = until;
  run_here(std::move(options),
           [](const runs::RunOptions& all, runs::RunRequests& requests) { resume_run(all, requests); });
}

} // namespace

void bind_run(py::module_& module) {
  module.def("start_run", &start, py::arg("scene"), py::arg("folder"), py::arg("force"));
  module.def("resume_run", &go_on, py::arg("folder"), py::arg("until"));
}

} // namespace keeler::python
