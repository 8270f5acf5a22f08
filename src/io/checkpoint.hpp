// Checkpoints: all that a run needs to continue exactly, written from a field table and read back into one. The layout
// is in docs/formats.md. A checkpoint that reads without an error is what was written, bit for bit.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/io/provenance.hpp>

#include <filesystem>
#include <memory>
#include <string>

namespace keeler::io {

/// Content of a checkpoint beside the fields.
struct CheckpointHeader {
  std::string scene; ///< the resolved scene, as TOML
  Provenance provenance;
};

/// Writes every field of the table, completely or not at all (see write_file()). Collective: the root rank writes.
/// Divided fields are stored with the rows of all ranks, in rank order; the root receives them piece by piece. Other
/// fields are stored as the root has them. Throws IoError. Precondition: names are unique and have no '/'.
void write_checkpoint(const std::filesystem::path& file, const FieldTable& table, const CheckpointHeader& header,
                      const Communicator& ranks = {});

/// A verified checkpoint, open for reading.
class Checkpoint {
public:
  /// Opens the file and verifies all of it, piece by piece. Collective: the root rank verifies, the others only compare
  /// the seal. Throws IoError when the file is damaged, of another kind or of a newer version.
  explicit Checkpoint(const std::filesystem::path& file, const Communicator& ranks = {});
  ~Checkpoint();

  /// The scene in it determines the table to pass to read().
  const CheckpointHeader& header() const;

  /// Fills every field of the table; the rows of divided fields are distributed over the ranks in order. Collective.
  /// Throws IoError, and does not change the table's data, unless the fields equal those of the table in name, type and
  /// shape.
  void read(const FieldTable& table) const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace keeler::io
