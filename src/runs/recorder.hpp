// Everything that a run writes. It reads the state and never changes it. It writes into the folder that the run
// holds and nowhere else: every call throws IoError once the folder's name stands for something else. Of a run that
// ranks share all make each call; the first rank writes, and what it throws all throw.
#pragma once

#include "contact_log.hpp"
#include "moonlet_columns.hpp"
#include "run_folder.hpp"

#include <keeler/files/naming_guard.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/simulation/simulation.hpp>

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>

namespace keeler {

/// What has been written so far; stored in the checkpoint, so that a resumed run counts on.
struct OutputCounters {
  std::int64_t snapshots = 0;
  std::int64_t checkpoints = 0;
  std::int64_t last_snapshot_step = -1; ///< -1: none yet
  ContactCounters contacts;             ///< only where the scene asks for a log of contacts

  void list_fields(FieldTable& table, const Scene& scene);
};

/// Wall time that output took, s.
struct OutputCosts {
  double series = 0.0, stresses = 0.0, snapshots = 0.0, checkpoints = 0.0, contacts = 0.0;
};

/// What became of the checks of forces.
struct ForceChecks {
  int count = 0;
  std::size_t particles = 0; ///< looked at in each
  std::int64_t last_step = -1;
  double last_rms = 0.0, worst_rms = 0.0; ///< rms error of the acceleration over the rms acceleration
  double last_s = 0.0, seconds = 0.0;     ///< wall time of the last one, and of all
};

class Recorder {
public:
  using Notice = std::function<void(const std::string&)>; ///< a line for the user; may be empty

  /// `resumed_at`: the series is continued from that step, else begun anew. The scene and the lock must outlive it; the
  /// first rank alone has a lock.
  Recorder(const RunFolder& folder, const FolderLock* lock, const Scene& scene,
           const std::vector<std::string>& arguments, OutputCounters counters, std::optional<std::int64_t> resumed_at,
           Notice notice, const Communicator& ranks);

  /// From now on contacts are logged, where the scene asks for it. The simulation must outlive its last step only.
  void watch(Simulation& simulation);
  /// Throws IoError when the folder's name stands for something else by now.
  void require_folder() const { lock_->require_in_place(); }

  /// After each step.
  void contacts();
  /// Tells of the rows that a resumed run did not find any more.
  void tell_losses();

  /// These throw InvariantError, and write nothing, where a number is not finite or the energy budget does not close.
  void snapshot(const Simulation& simulation);
  void checkpoint(const Simulation& simulation);
  void sample(const Simulation& simulation);
  /// Holds the accelerations of some particles against the exact ones, and logs the error. Only where a step has ended
  /// with a kick, or at the start.
  void check_forces(const Simulation& simulation);
  void log(const std::string& event, const nlohmann::ordered_json& details);
  /// Of the first rank alone.
  void write_log(const std::string& event, const nlohmann::ordered_json& details);
  void summary(const Record& summary);
  const OutputCounters& counters() const { return counters_; }
  const Provenance& provenance() const { return provenance_; }
  const ForceChecks& force_checks() const { return force_checks_; }
  const OutputCosts& costs() const { return costs_; }

private:
  void open(std::optional<std::int64_t> resumed_at);
  void append(const SeriesSample& row, const std::vector<std::vector<double>>& moonlets);
  void tell_what_was_lost();
  std::optional<GravityEnergy> measure_gravity(const Simulation& simulation);
  void require_sound(const SimulationState& state, const ParticleMeans& means);
  void require_sound(const Simulation& simulation);
  void tell(const std::string& text) const;
  void tell_restored(Series& series, const std::filesystem::path& file);
  void tell_restored();
  void tell_lost_rows(const Series& series, const std::filesystem::path& file);

  RunFolder folder_;
  const FolderLock* lock_;
  Communicator ranks_;
  NamingGuard guard_{[this] {
    if (lock_)
      lock_->require_in_place();
  }};
  const Scene& scene_;
  Provenance provenance_;
  OutputCounters counters_;
  Notice notice_;
  std::vector<SeriesColumn> columns_;
  std::optional<Series> series_; // the first rank's
  std::vector<MoonletColumn> moonlet_columns_;
  std::optional<Series> moonlets_;        // the same; only where the scene has some
  std::optional<ContactLog> contact_log_; // the first rank's, to which the others give theirs
  struct ForFirst final : DriftObserver {
    bool wants_events() const override { return false; }
    bool wants_records() const override { return true; }
  } for_first_;
  std::int64_t sound_step_ = -1; // whose state was sound
  ForceChecks force_checks_;
  OutputCosts costs_;
};

} // namespace keeler
