// Checkpoints: all that a run needs to continue exactly, taken from a field table and given back to one. The layout is
// in docs/formats.md. A checkpoint that reads without an error is what was written, bit for bit.
#pragma once

#include <keeler/core/field_table.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/ranks/ranks.hpp>

#include <filesystem>
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
                      const Ranks& ranks = {});

/// Fills every field of the table. Throws IoError, and leaves the table's data alone, when the file is damaged, of
/// another kind or a newer version, or when its fields are not those of the table in name, type and shape.
CheckpointHeader read_checkpoint(const std::filesystem::path& file, const FieldTable& table);

/// Verifies the whole file and returns what stands beside the fields: the scene says which table to make.
CheckpointHeader read_checkpoint_header(const std::filesystem::path& file);

} // namespace keeler
