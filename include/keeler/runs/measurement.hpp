// What is measured on snapshots and of a run's series, as numbers with names: all that `keeler analyze`, its pages,
// sweeps and Python tell of a patch. A new number is one more row of the table in measurement.cpp.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/runs/measured_part.hpp>

#include <functional>

namespace keeler {

/// Typed results. Rows of the table may look at the patches too.
struct Measurement {
  std::span<const Patch> patches;
  Analysis analysis;
  double largest_overlap = 0.0; ///< in any of the patches, of a radius sum
  TransportReport transport;
  PatchUnits units; ///< of the last patch

  /// A number of one snapshot, as the mean over all of them.
  double mean_over_snapshots(double (*of)(const Patch&)) const;
};

/// Refers to the patches, which must outlive it. `looked_at` is called after each one. Throws UsageError as analyze().
Measurement measure(std::span<const Patch> patches, const TransportReport& transport,
                    const AnalysisSettings& settings = {}, const std::function<void()>& looked_at = {});

Record record_of(const Measurement& measurement);

/// The wakes alone, of one patch at least.
Record wakes_of(std::span<const Patch> patches);

/// Names, units and meanings, in the order of a record.
std::vector<Quantity> measured_quantities();

} // namespace keeler
