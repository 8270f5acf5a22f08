// The transport of angular momentum as `keeler analyze` reports it: the viscosities of a run from its series, or those
// of a snapshot at its instant.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/transport.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace keeler {

/// Returns what the waves hold in the two halves, and what it means where that is not steady; a part of a sentence.
std::string words_of(const WaveGrowth& waves);

class TransportReport {
public:
  /// Of a run's folder: from its series. Without a viscosity when that has too few rows in the window.
  static TransportReport of_run(const std::filesystem::path& folder, const RingScale& scale, const OrbitWindow& window);

  /// Of a run's series, which has been read.
  static TransportReport of_series(const SeriesTable& series, const RingScale& scale, const OrbitWindow& window);

  /// Of a snapshot of a scene with these settings of gravity.
  static TransportReport of_snapshot(const Patch& patch, const std::optional<GravitySettings>& gravity);

  /// None: the series has too few rows for a viscosity.
  const std::optional<Transport>& transport() const { return transport_; }

  bool is_of_run() const { return of_run_; }

private:
  std::optional<Transport> transport_;
  bool of_run_ = false;
};

/// The viscosities and the balance of energy, under their names.
Record record_of(const TransportReport& transport, const PatchUnits& units);
std::vector<Quantity> transport_quantities();

} // namespace keeler
