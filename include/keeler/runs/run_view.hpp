// What a run's folder tells somebody who looks on while the run works. Nothing is changed, and nothing is waited for.
#pragma once

#include <keeler/io/series.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace keeler {

struct RunView {
  bool running = false;                      ///< a process works in the folder
  std::string last_event;                    ///< of the log: "started", "finished", ...
  std::uint64_t particles = 0;               ///< at the start
  double orbits = 0.0;                       ///< of the newest row of the series
  double first_orbits = 0.0;                 ///< where the run began or resumed for the last time
  double end_orbits = 0.0;                   ///< where it is to end
  std::optional<double> began_s;             ///< when that was, s since 1970
  bool unended = false;                      ///< the command that did so has not said that it ended
  std::optional<double> ended_s = 0.0;       ///< wall time of those before; none when one of them was killed
  SeriesTable series;                        ///< as far as it is written
  std::string snapshot, checkpoint, picture; ///< names of the newest ones, empty where there are none

  double share() const;      ///< of the whole run, 0 … 1
  std::string state() const; ///< "running", "finished", "stopped", "broken" (an invariant), or "not running" where it
                             ///< was killed or failed
  /// Wall time left (s) at the speed since it began or resumed; none where nobody can know.
  std::optional<double> remaining_s(double now_s) const;
  /// Wall time of all commands on the run; none where nobody can know.
  std::optional<double> wall_s(double now_s) const;
};

/// Throws IoError when the folder holds no run, or a file of it cannot be read.
RunView view_run(const std::filesystem::path& folder);

} // namespace keeler
