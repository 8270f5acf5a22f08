// The summary of a run, written when it ends or stops.
#pragma once

#include "recorder.hpp"

#include <keeler/runs/run.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/runs/transport.hpp>

namespace keeler::runs {

/// The costs of this command: of the part of the run since its start, or since a resume after `first_step` steps.
struct RunCost {
  std::int64_t first_step = 0;
  double first_orbit = 0.0;
  double wall_s = 0.0, cpu_s = 0.0, start_s = 0.0;
  OutputCosts output;
  ForceChecks force_checks;
};

/// Computes the transport from the series of the run. A damaged series gives none and a notice: the run still ends
/// normally.
std::optional<Transport> transport_of_run(const std::filesystem::path& series, const RingScale& scale,
                                          const std::function<void(const std::string&)>& notice);

/// The sources of the numbers of a summary.
struct SummarySource {
  Simulation& simulation;
  const Scene& scene;
  const std::optional<Transport>& transport;
  const RunResult& result;
  const RunCost& cost;
  double largest_overlap; ///< at present, as a fraction of the radius sum
  simulation::EnergyBalance balance;
};

/// Returns the summary: counts and energies of the whole run, times of this command. Collective; only the root's record
/// is complete.
quantities::Record summarise(Simulation& simulation, const Scene& scene, const std::optional<Transport>& transport,
                             const RunResult& result, const RunCost& cost, const io::Provenance& provenance);

/// Returns true if the folder's summary is of a finished run; false if it is missing or damaged.
bool says_finished(const std::filesystem::path& folder);

} // namespace keeler::runs
