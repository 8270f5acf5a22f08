// A run as one page of HTML that needs no other file and no network: pictures through time, the particles in three
// dimensions, plots of its series, numbers with errors, its scene, what it cost and where it comes from.
#pragma once

#include <keeler/core/progress.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace keeler {

inline constexpr std::size_t max_particles_in_view = 100'000; ///< beyond that the view shows this many, evenly by id

struct RunReportOptions {
  std::size_t snapshots = 8; ///< at most so many in the view, evenly through the run
  std::function<void(const Progress&)> progress;
};

/// The page of a run's folder; the run may still be working. Throws IoError when the folder holds no run or no
/// snapshot.
std::string run_report(const std::filesystem::path& folder, const RunReportOptions& options = {});

} // namespace keeler
