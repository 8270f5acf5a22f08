// The measured quantities of snapshots and of a run's series, as named numbers: everything that `keeler analyze`, its
// pages, sweeps and Python report on a patch. A new quantity is one more row of the table in measurement.cpp.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/runs/measured_part.hpp>

#include <functional>

namespace keeler::runs {

/// Typed results. Rows of the table may also compute from the patches.
struct Measurement {
  std::span<const Patch> patches;
  diagnostics::Analysis analysis;
  double largest_overlap = 0.0; ///< of any pair in any patch, as a fraction of the radius sum
  TransportReport transport;
  quantities::PatchUnits units; ///< of the last patch

  /// Returns the mean of a function of one snapshot over all snapshots. Precondition: `patches` is not empty.
  double mean_over_snapshots(const std::function<double(const Patch&)>& value) const;
};

/// Measures patches, oldest first; the result refers to them, so they must outlive it. `patch_done` is called after
/// each patch. Precondition: `patches` is not empty. Throws UsageError as analyze().
Measurement measure(std::span<const Patch> patches, const TransportReport& transport,
                    const diagnostics::AnalysisSettings& settings = {}, const std::function<void()>& patch_done = {});

/// Returns all measured quantities as a record.
quantities::Record record_of(const Measurement& measurement);

/// Returns the wake quantities alone. Precondition: `patches` is not empty.
quantities::Record wakes_of(std::span<const Patch> patches);

/// Returns names, units and meanings, in the order of a record.
std::vector<quantities::Quantity> measured_quantities();

} // namespace keeler::runs
