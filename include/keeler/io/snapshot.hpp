// Snapshots: a patch of ring at one instant, in SI, in one HDF5 file that GADGET readers (yt, h5py) and ParaView open
// unaided. The layout is in docs/formats.md; give the file the ending ".hdf", which ParaView wants.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <map>
#include <memory>
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

/// A snapshot in the making, whose particles come a piece at a time. Complete or not at all: it takes its name when it
/// is finished, as of write_file(). Throws IoError.
class SnapshotFile {
public:
  /// Particles of a piece; the last one may have fewer.
  static constexpr std::size_t piece = std::size_t{1} << 17;

  /// `frame`: all of the patch but its particles, of which there will be `count`, rough or not. Its orbital frequency
  /// is known.
  SnapshotFile(const std::filesystem::path& file, const Patch& frame, std::size_t count, bool rough,
               const SnapshotMeta& meta);
  ~SnapshotFile();

  /// The next particles, in the order of their ids: those of a patch from the `first` one on, or all of it.
  void add(const Patch& patch, std::size_t first, std::size_t count);
  void add(const Patch& patch) { add(patch, 0, patch.size()); }
  void finish();

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Writes a whole patch. Throws IoError.
void write_snapshot(const std::filesystem::path& file, const Patch& patch, const SnapshotMeta& meta);

/// Reads a snapshot, also one that another tool has changed. All comes back bit for bit except velocities, which pass
/// through m/s and may differ by 2.2e-16 of their value (two roundings). Throws IoError for damage, for another kind of
/// file, and where an array is missing, is of another length, or the ids do not increase.
///
/// Collective: each rank gets a part of the particles, and all else; where another tool has changed the file, the first
/// rank gets all of it and the others nothing.
Snapshot read_snapshot(const std::filesystem::path& file, const Communicator& ranks = {});

/// Returns the seal at the end of a snapshot, which tells its content from another one's; empty where there is none, or
/// no such file.
std::string snapshot_seal(const std::filesystem::path& file);

} // namespace keeler
