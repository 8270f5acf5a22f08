// The part of a run that is measured: its steady part, or a requested window of orbits.
#pragma once

#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/transport_report.hpp>

#include <filesystem>

namespace keeler::runs {

struct MeasuredPart {
  StoredPatches stored; ///< the snapshots in that part
  TransportReport transport;
};

/// Loads the snapshots of a run's folder inside the window, and their transport. A missing bound is taken from the
/// series: the orbit at which it becomes steady, the last row. If `path` is a snapshot file, that snapshot is measured.
/// Throws UsageError for a window of a snapshot file, or a window without snapshots; IoError.
MeasuredPart measured_part(const std::filesystem::path& path, const OrbitWindow& window);

} // namespace keeler::runs
