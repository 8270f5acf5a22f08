// A report on a run: one self-contained HTML page with pictures through time, the particles in three dimensions, plots
// of the series, measured numbers with errors, the scene, costs and provenance.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/quantities/quantity.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace keeler::run_report {

inline constexpr std::size_t max_particles_in_view = 100'000; ///< of more, the view shows this many, evenly by id

struct RunReportOptions {
  std::size_t snapshots = 8;                   ///< maximum number in the view, evenly through the run
  std::optional<quantities::UnitSystem> units; ///< of velocities and viscosities; none: the forms of each number
  std::function<void(const Progress&)> progress;
};

/// Returns the page of a run's folder; the run may be in progress. Throws IoError when the folder holds no run or no
/// snapshot.
std::string run_report(const std::filesystem::path& folder, const RunReportOptions& options = {});

} // namespace keeler::run_report
