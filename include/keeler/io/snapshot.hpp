// Snapshots: a patch of ring at one instant, in SI, in one HDF5 file that GADGET readers (yt, h5py) and ParaView open
// without plug-ins. The layout is in docs/formats.md. ParaView needs the extension ".hdf".
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace keeler::io {

/// Program, machine and command line of a file, never part of a hash: name → value: version, commit, compiler, flags,
/// libraries, host, threads, arguments, started (UTC).
using Provenance = std::map<std::string, std::string>;

/// Content of a snapshot beside the patch.
struct SnapshotMeta {
  std::string scene;                                        ///< the resolved scene, as TOML
  Provenance provenance;                                    ///< of the program that wrote it
  std::map<std::string, std::vector<double>> clumping = {}; ///< how a clumped state was made; empty for other states
};

/// The content of a snapshot file.
struct Snapshot {
  Patch patch;       ///< in internal units
  SnapshotMeta meta; ///< all else
};

/// Writes a snapshot; the particles are added piece by piece. The file appears under its name, complete, in finish();
/// without finish() there is none (see write_file()). All members throw IoError.
class SnapshotFile {
public:
  /// Particles per piece; the last piece may have fewer.
  static constexpr std::size_t piece = std::size_t{1} << 17;

  /// Creates a file for `count` particles, with spins if `rough`. Everything else is taken from `frame`;
  /// its particles are ignored. Precondition: frame.orbital_frequency > 0.
  SnapshotFile(const std::filesystem::path& file, const Patch& frame, std::size_t count, bool rough,
               const SnapshotMeta& meta);
  ~SnapshotFile();

  /// Writes the next particles, patch[first, first + count), in the order of ids. Precondition: every call but the last
  /// adds a multiple of `piece`.
  void add(const Patch& patch, std::size_t first, std::size_t count);
  /// As above, for all particles of the patch.
  void add(const Patch& patch) { add(patch, 0, patch.size()); }
  /// Completes the file. Precondition: all particles have been added.
  void finish();

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Writes a whole patch. Throws IoError.
void write_snapshot(const std::filesystem::path& file, const Patch& patch, const SnapshotMeta& meta);

/// Reads a snapshot, also one that another tool has changed. Everything is read back bit for bit except velocities,
/// which are converted to m/s and back: relative error at most 2.2e-16 (two roundings). Throws IoError for damage, for
/// another kind of file, and when an array is missing, has another length, or the ids do not increase.
///
/// Collective: each rank gets a part of the particles, and everything else. If another tool has changed the file, the
/// root rank gets everything and the others nothing.
Snapshot read_snapshot(const std::filesystem::path& file, const Communicator& ranks = {});

/// Returns the seal at the end of a snapshot, a fingerprint of its content; empty when there is no seal or no such
/// file.
std::string snapshot_seal(const std::filesystem::path& file);

} // namespace keeler::io
