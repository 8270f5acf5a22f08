#include "broken_state.hpp"

#include <keeler/initial_conditions/broken.hpp>

#include <fmt/format.h>

namespace keeler::runs {

void fail_broken(const InvariantError& error, const Simulation& simulation, const Scene& scene, const RunFolder& folder,
                 Recorder& recorder) {
  const initial_conditions::BrokenState broken(error, simulation);
  std::string message = save_broken(broken, folder.broken(broken.step), {scene.resolved, recorder.provenance()});
  try {
    recorder.log("broken", {{"step", broken.step}, {"orbits", broken.patch.time_orbits}, {"reason", error.what()}});
  } catch (const IoError& not_logged) {
    message += fmt::format("; the log was not written: {}", not_logged.what());
  }
  throw InvariantError(message);
}

} // namespace keeler::runs
