// The part of a run that is measured: where it is steady, or what was asked for.
#pragma once

#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/transport_report.hpp>

#include <filesystem>

namespace keeler {

struct MeasuredPart {
  StoredPatches stored; ///< its snapshots
  TransportReport transport;
};

/// Of a run's folder: the series says from where on it is steady, and snapshots are taken from there; or the window's
/// orbits. A snapshot stands for itself. Throws UsageError for a window of a snapshot, or one without a snapshot in it;
/// IoError.
MeasuredPart measured_part(const std::filesystem::path& path, const OrbitWindow& window);

} // namespace keeler
