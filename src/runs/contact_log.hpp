// The log of contacts: the contacts that the scene selects, as rows of one table in the order of events, and a
// histogram of the impact speeds of all contacts.
//
// The table is split into files of `rows_per_file` rows. The last file is rewritten before each checkpoint, so a
// checkpoint stores only the number of rows: on resume the rows beyond it are cut off, and the files equal the files
// of an uninterrupted run, whatever its checkpoints. Invariant: files before the last are full and never change.
#pragma once

#include "impact_speeds.hpp"
#include "run_folder.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/io/contacts.hpp>
#include <keeler/io/series.hpp>
#include <keeler/simulation/simulation.hpp>

namespace keeler::runs {

/// The part of the log that a checkpoint stores.
struct ContactCounters {
  std::int64_t rows = 0; ///< number of rows of the table
  ImpactSpeeds speeds;   ///< since the last snapshot

  void list_fields(FieldTable& table);
};

/// The position in the log at which a resumed run continues.
struct LogResume {
  ContactCounters counters;
  std::int64_t last_snapshot_step; ///< −1: none yet
};

/// Returns true if the log selects a contact. The random choice depends on its time (orbits) and ids alone.
bool is_logged(const scene::ContactLogSettings& settings, const collision::CollisionRecord& record, double time_orbits,
               double orbital_frequency);

/// The particles of the contacts at rest that are to be logged at this boundary: none where the scene does not ask for
/// them, and between kicks.
struct MembersAtRest {
  std::vector<std::uint64_t> ids; ///< in increasing order
  std::vector<Body> bodies;       ///< of each
};
/// Collective. Precondition: the scene has a log of contacts.
MembersAtRest members_at_rest(const Scene& scene, Simulation& simulation);

class ContactLog final : public collision::DriftObserver {
public:
  static constexpr std::int64_t rows_per_file = std::int64_t{1} << 19;

  /// Begins a log, or continues one. The scene must outlive it. Throws IoError when the log cannot be written.
  ContactLog(const RunFolder& folder, const Scene& scene, const io::Provenance& provenance,
             const std::optional<LogResume>& resume, std::int64_t file_rows = rows_per_file);

  /// Registers this log for the contacts of all following steps. The log must outlive them.
  void watch(Simulation& simulation);

  /// Adds the contacts at rest that carry the kick at this boundary. Call it after each step.
  void add_contacts_at_rest(const MembersAtRest& members);
  /// Writes the files that are full. Call it after each step.
  void write_full_files();
  /// Writes all rows so far. Call it before a checkpoint.
  void write_all();
  /// Writes the histogram of impact speeds since the last snapshot, and clears it.
  void end_interval(std::int64_t last_snapshot_step, std::int64_t step);

  const ContactCounters& counters() const { return counters_; }
  /// Returns the number of rows that were missing on resume.
  std::int64_t lost_rows() const { return lost_rows_; }
  io::Series& speeds() { return speeds_; }

  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const collision::CollisionRecord> records) override;

private:
  void load_last_file();
  void write_file(std::size_t rows);

  RunFolder folder_;
  const Scene& scene_;
  io::Provenance provenance_;
  std::int64_t file_rows_;
  ContactCounters counters_;
  io::Series speeds_;
  const Simulation* simulation_ = nullptr;
  std::vector<io::ContactRow> rows_; // of the last file, and later rows until it is written
  std::int64_t first_row_ = 0;       // index of rows_.front() in the table
  std::int64_t written_ = -1;        // number of rows on disk
  std::int64_t lost_rows_ = 0;
};

} // namespace keeler::runs
