// What a run came to, when it ends or stops.
#pragma once

#include "recorder.hpp"

#include <keeler/io/provenance.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/runs/transport.hpp>

namespace keeler {

/// What this stretch of the run took: since it began or was resumed when first_step steps were done.
struct RunCost {
  std::int64_t first_step = 0;
  double first_orbit = 0.0;
  double wall_s = 0.0, cpu_s = 0.0, start_s = 0.0;
  OutputCosts output;
  ForceChecks force_checks;
};

/// By the series of the run. None, with a notice where it is damaged: that must not keep a run from ending well.
std::optional<Transport> transport_of_run(const std::filesystem::path& series, const RingScale& scale,
                                          const std::function<void(const std::string&)>& notice);

/// What the numbers of a summary are read from.
struct SummarySource {
  Simulation& simulation;
  const Scene& scene;
  const std::optional<Transport>& transport;
  const RunResult& result;
  const RunCost& cost;
  double largest_overlap; ///< now
  EnergyBalance balance;
};

/// Counts and energies are those of the whole run, times those of this stretch. Collective; the first rank's is the
/// one.
Record summarise(Simulation& simulation, const Scene& scene, const std::optional<Transport>& transport,
                 const RunResult& result, const RunCost& cost, const Provenance& provenance);

/// Whether the folder's summary is that of a finished run. False when there is none, or one that is damaged.
bool says_finished(const std::filesystem::path& folder);

} // namespace keeler
