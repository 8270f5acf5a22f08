// The log of contacts: those that the scene asks for, as rows of one long table in the order of events, and how fast
// all contacts were.
//
// The table lies in files of `rows_a_file` rows. The last one is written anew whenever it is to be on disk, so a
// checkpoint needs to know no more than the number of rows: on resume the rows beyond it are cut off, and the files are
// those of a run without a break, whenever it had its checkpoints. Invariant: files before the last are full and never
// change.
#pragma once

#include "impact_speeds.hpp"
#include "run_folder.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/io/contacts.hpp>
#include <keeler/io/series.hpp>
#include <keeler/simulation/simulation.hpp>

namespace keeler {

/// What of the log stands in a checkpoint.
struct ContactCounters {
  std::int64_t rows = 0; ///< of the table
  ImpactSpeeds speeds;   ///< since the last snapshot

  void list_fields(FieldTable& table);
};

/// Where a run goes on.
struct LogResume {
  ContactCounters counters;
  std::int64_t last_snapshot_step; ///< −1: none yet
};

/// Whether a contact is for the log; its time in orbits stands for its step.
bool is_logged(const ContactLogSettings& settings, const CollisionRecord& record, double time_orbits,
               double orbital_frequency);

class ContactLog final : public DriftObserver {
public:
  static constexpr std::int64_t rows_a_file = std::int64_t{1} << 19;

  /// Begins a log, or goes on with one. Throws IoError when it cannot be written.
  ContactLog(const RunFolder& folder, const Scene& scene, const Provenance& provenance,
             const std::optional<LogResume>& resume, std::int64_t file_rows = rows_a_file);

  /// Takes the contacts of all steps from now on. Both must outlive its use.
  void watch(Simulation& simulation);

  /// After a step: writes the files that are full.
  void write_full_files();
  /// Writes all rows so far: before a checkpoint.
  void write_all();
  /// Writes the impact speeds since the last snapshot and begins anew.
  void end_interval(std::int64_t last_snapshot_step, std::int64_t step);

  const ContactCounters& counters() const { return counters_; }
  /// Rows that a resumed run did not find any more.
  std::int64_t lost() const { return lost_; }
  Series& speeds() { return speeds_; }

  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const CollisionRecord> records) override;

private:
  void take_up();
  void write_file(std::size_t rows);

  RunFolder folder_;
  const Scene& scene_;
  Provenance provenance_;
  std::int64_t file_rows_;
  ContactCounters counters_;
  Series speeds_;
  const Simulation* simulation_ = nullptr;
  std::vector<ContactRow> rows_; // of the last file, and more until it is written
  std::int64_t first_row_ = 0;   // of them in the table
  std::int64_t written_ = -1;    // rows of the table that are on disk
  std::int64_t lost_ = 0;
};

} // namespace keeler
