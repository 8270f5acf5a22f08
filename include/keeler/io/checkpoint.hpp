// Checkpoints: all that a run needs to continue exactly, taken from a field table and given back to one. The layout is
// in docs/formats.md. A checkpoint that reads without an error is what was written, bit for bit.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/io/provenance.hpp>

#include <filesystem>
#include <memory>
#include <string>

namespace keeler {

/// What stands in a checkpoint beside the fields.
struct CheckpointHeader {
  std::string scene; ///< the resolved scene, as TOML
  Provenance provenance;
};

/// Writes every field of the table; names are unique and have no '/'. Complete or not at all: see write_file().
/// Collective: the first rank writes. Of divided fields the file has the rows of all ranks, in the order of the ranks,
/// which come to the first one a piece at a time; of others it has those of the first. Throws IoError.
void write_checkpoint(const std::filesystem::path& file, const FieldTable& table, const CheckpointHeader& header,
                      const Communicator& ranks = {});

/// A checkpoint that is whole, open for reading where it is.
class Checkpoint {
public:
  /// Looks through the whole file, a piece at a time. Collective: the first rank does, the others trust its seal.
  /// Throws IoError when it is damaged, of another kind or a newer version.
  explicit Checkpoint(const std::filesystem::path& file, const Communicator& ranks = {});
  ~Checkpoint();

  /// The scene says which table to make.
  const CheckpointHeader& header() const;

  /// Fills every field of the table; of divided ones each rank gets a part of the rows, the first rank the first ones.
  /// Collective. Throws IoError, and leaves the table's data alone, when the fields are not those of the table in name,
  /// type and shape.
  void read(const FieldTable& table) const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace keeler
