// All output of a run. It never changes the state. It writes only into the folder that the run has locked: every call
// throws IoError once the path names another folder. In a distributed run all ranks make each call; the root writes,
// and an exception of the root is thrown on all ranks.
#pragma once

#include "contact_log.hpp"
#include "moonlet_columns.hpp"
#include "run_folder.hpp"

#include <keeler/files/naming_guard.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/simulation/simulation.hpp>

#include <nlohmann/json.hpp>

#include <cassert>
#include <functional>
#include <optional>
#include <string>

namespace keeler::runs {

/// Counters of the files written; stored in the checkpoint, so that a resumed run continues them.
struct OutputCounters {
  std::int64_t snapshots = 0;
  std::int64_t checkpoints = 0;
  std::int64_t last_snapshot_step = -1; ///< -1: none yet
  ContactCounters contacts;             ///< used only if the scene requests a log of contacts

  void list_fields(FieldTable& table, const Scene& scene);
};

/// Wall time of output, s.
struct OutputCosts {
  double series = 0.0, stresses = 0.0, snapshots = 0.0, checkpoints = 0.0, contacts = 0.0;
};

/// Results of the force checks.
struct ForceChecks {
  int count = 0;
  std::size_t particles = 0; ///< per check
  std::int64_t last_step = -1;
  double last_rms = 0.0, worst_rms = 0.0; ///< rms error of the acceleration over the rms acceleration
  double last_s = 0.0, seconds = 0.0;     ///< wall time of the last check, and of all
};

class Recorder {
public:
  using Notice = std::function<void(const std::string&)>; ///< a line for the user; may be empty

  /// Continues the series from the step `resumed_at`, or begins new ones if that is none. `lock` is null except on the
  /// root. The scene and the lock must outlive the recorder.
  Recorder(const RunFolder& folder, const FolderLock* lock, const Scene& scene,
           const std::vector<std::string>& arguments, OutputCounters counters, std::optional<std::int64_t> resumed_at,
           Notice notice, const Communicator& ranks);

  /// Logs the contacts of the following steps, if the scene requests it. The simulation must outlive its last step.
  void watch(Simulation& simulation);
  /// Throws IoError when the path no longer names the locked folder. Precondition: this is the root.
  void require_folder() const {
    assert(lock_ != nullptr);
    lock_->require_in_place();
  }

  /// Writes the full files of the log of contacts. Call it after each step.
  void contacts(Simulation& simulation);
  /// Reports rows that were missing in the files of a resumed run.
  void report_losses();

  /// Writes a snapshot, a checkpoint, a row of the series. Each throws InvariantError, and writes nothing, when a
  /// number is not finite or the energy budget does not close.
  void snapshot(const Simulation& simulation);
  void checkpoint(const Simulation& simulation);
  void sample(const Simulation& simulation);
  /// Compares the accelerations of some particles with the exact ones, and logs the error. Precondition: the last step
  /// ended with a kick, or the run has just started.
  void check_forces(const Simulation& simulation);
  void log(const std::string& event, const nlohmann::ordered_json& details);
  /// Appends an event to the log. Precondition: this is the root.
  void write_log(const std::string& event, const nlohmann::ordered_json& details);
  void summary(const quantities::Record& summary);
  const OutputCounters& counters() const { return counters_; }
  const io::Provenance& provenance() const { return provenance_; }
  const ForceChecks& force_checks() const { return force_checks_; }
  const OutputCosts& costs() const { return costs_; }

private:
  void open(std::optional<std::int64_t> resumed_at);
  void append(const SeriesSample& row, const std::vector<double>& values,
              const std::vector<std::vector<double>>& moonlets);
  void report_losses_on_root();
  std::optional<gravity::GravityEnergy> measure_gravity(const Simulation& simulation);
  void require_sound(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means);
  void require_sound(const Simulation& simulation);
  void notify(const std::string& text) const;
  void report_restored(io::Series& series, const std::filesystem::path& file);
  void report_restored();
  void report_lost_rows(const io::Series& series, const std::filesystem::path& file);

  RunFolder folder_;
  const FolderLock* lock_;
  Communicator ranks_;
  files::NamingGuard guard_{[this] {
    if (lock_)
      lock_->require_in_place();
  }};
  const Scene& scene_;
  io::Provenance provenance_;
  OutputCounters counters_;
  Notice notice_;
  std::vector<SeriesColumn> all_columns_; // on all ranks
  std::vector<SeriesColumn> columns_;     // of the file, on the root
  std::optional<io::Series> series_;      // on the root
  std::vector<MoonletColumn> moonlet_columns_;
  std::optional<io::Series> moonlets_;                      // on the root, if the scene has moonlets
  std::optional<ContactLog> contact_log_;                   // on the root, which receives the other ranks' contacts
  struct RecordRequester final : collision::DriftObserver { // for the other ranks: their contacts are sent to the root
    bool wants_events() const override { return false; }
    bool wants_records() const override { return true; }
  } record_requester_;
  std::int64_t sound_step_ = -1; // the last step that passed require_sound()
  ForceChecks force_checks_;
  OutputCosts costs_;
};

} // namespace keeler::runs
