// Angular momentum transport as `keeler analyze` reports it: the viscosities of a run from its series, or the
// instantaneous ones of a snapshot.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/transport.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace keeler::runs {

/// Returns part of a sentence: the energy fractions of the waves in both halves, and the consequence if they differ.
std::string describe(const WaveGrowth& waves);

class TransportReport {
public:
  /// Reads the series of a run's folder. The report has no viscosity if the window has too few rows.
  static TransportReport of_run(const std::filesystem::path& folder, const RingScale& scale, const OrbitWindow& window);

  /// As of_run(), from a series that was already read.
  static TransportReport of_series(const io::SeriesTable& series, const RingScale& scale, const OrbitWindow& window);

  /// Reports a snapshot of a scene with these gravity settings.
  static TransportReport of_snapshot(const Patch& patch, const std::optional<GravitySettings>& gravity);

  /// Returns none if the series has too few rows for a viscosity.
  const std::optional<Transport>& transport() const { return transport_; }

  bool is_of_run() const { return of_run_; }

private:
  std::optional<Transport> transport_;
  bool of_run_ = false;
};

/// Returns the viscosities and the energy balance as named numbers.
quantities::Record record_of(const TransportReport& transport, const quantities::PatchUnits& units);
std::vector<quantities::Quantity> transport_quantities();

} // namespace keeler::runs
