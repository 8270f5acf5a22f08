// Snapshots: a patch of ring at one instant, in SI, in one HDF5 file that GADGET readers (yt, h5py) and ParaView open
// unaided. The layout is in docs/formats.md; give the file the ending ".hdf", which ParaView wants.
#pragma once

#include <keeler/io/provenance.hpp>
#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

/// What stands in a snapshot beside the patch.
struct SnapshotMeta {
  std::string scene; ///< the resolved scene, as TOML
  Provenance provenance;
  std::map<std::string, std::vector<double>> clumping = {}; ///< how a clumped state came about; empty for any other
};

struct Snapshot {
  Patch patch;
  SnapshotMeta meta;
};

/// Writes a patch whose orbital frequency is known. Complete or not at all: see write_file(). Throws IoError.
void write_snapshot(const std::filesystem::path& file, const Patch& patch, const SnapshotMeta& meta);

/// Reads a snapshot, also one that another tool has changed. All comes back bit for bit except velocities, which pass
/// through m/s and may differ by 2.2e-16 of their value (two roundings). Throws IoError for damage, for another kind of
/// file, and where an array is missing, is of another length, or the ids do not increase.
Snapshot read_snapshot(const std::filesystem::path& file);

} // namespace keeler
