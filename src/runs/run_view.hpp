// A read-only view of a run's folder while the run may be in progress. It changes no file and never blocks.
#pragma once

#include <keeler/io/series.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace keeler::runs {

struct RunView {
  bool running = false;                      ///< a process holds the folder
  std::string last_event;                    ///< in the log: "started", "finished", ...
  std::uint64_t particles = 0;               ///< at the start
  double orbits = 0.0;                       ///< of the newest row of the series
  double first_orbits = 0.0;                 ///< at the last start or resume
  double end_orbits = 0.0;                   ///< planned end
  std::optional<double> began_s;             ///< time of that start or resume, s since 1970
  bool end_missing = false;                  ///< the log has no end of that command
  std::optional<double> ended_s = 0.0;       ///< wall time of the ended commands; none if one was killed
  io::SeriesTable series;                    ///< rows written so far
  std::string snapshot, checkpoint, picture; ///< names of the newest files; empty if there is none

  double completed_fraction() const; ///< of the whole run, 0 … 1
  /// Returns "running", "finished", "stopped", "broken" (an invariant), or "not running" after a kill or an error.
  std::string state() const;
  /// Returns the wall time left (s) at the speed since the last start or resume; none if it cannot be estimated.
  std::optional<double> remaining_s(double now_s) const;
  /// Returns the wall time (s) of all commands of the run; none if one was killed.
  std::optional<double> wall_s(double now_s) const;
};

/// Throws IoError when the folder holds no run, or one of its files cannot be read.
RunView view_run(const std::filesystem::path& folder);

} // namespace keeler::runs
