// The snapshots of a run's folder, or one snapshot, as frames.
#pragma once

#include "encoder.hpp"
#include "throttle.hpp"

#include <keeler/runs/transport.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::live_view {

class Past {
public:
  /// `path` is a folder, which may not exist yet, or a file; empty: there is no past.
  explicit Past(std::filesystem::path path) : path_(std::move(path)) {}

  /// Returns the names of the snapshots, oldest first. A folder is searched at most once a second.
  const std::vector<std::string>& names();

  /// Encodes a snapshot. Throws IoError and UsageError as reading does. Precondition: k < names().size().
  Frame frame(std::size_t k, render::ColourField field);

  /// Returns true if the particles of the snapshot that was read last have spins.
  bool has_spins() const { return !patch_.spins.empty(); }

  /// Returns the scale of the run's series, from its first snapshot; none if there is no snapshot yet.
  std::optional<runs::RingScale> scale();

  /// Returns true if snapshots may be read while another thread of this process writes some.
  static bool is_safe_beside_a_run();

private:
  std::filesystem::path file_of(const std::string& name) const;
  const Patch& patch(const std::string& name);

  std::filesystem::path path_;
  std::vector<std::string> names_;
  Throttle search_{1.0, 0.02};
  std::string read_; // the name of the snapshot in patch_
  Patch patch_;
  std::optional<runs::RingScale> scale_;
};

} // namespace keeler::live_view
