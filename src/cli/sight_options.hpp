// keeler analyze --elevation …: occultations of a star by the ring, along several lines of sight.
#pragma once

#include <keeler/diagnostics/occultation.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <vector>

namespace keeler::cli {

struct SightOptions {
  std::vector<double> elevations, azimuths; ///< degrees
  std::size_t rays = 1000000;               ///< per snapshot and line of sight
  double footprint = 10.0;                  ///< m

  void add_to(CLI::App& command);
  bool requested() const { return !elevations.empty(); }
};

/// Occultations at all requested azimuths of each elevation; without azimuths every 10° of half a turn.
class Sights {
public:
  /// Precondition: there are patches and at least one elevation.
  Sights(const SightOptions& options, std::span<const Patch> patches);

  nlohmann::ordered_json json() const;
  void print() const;

private:
  struct Elevation {
    double degrees;
    std::vector<double> azimuths; // degrees
    std::vector<diagnostics::Occultation> sights;
  };

  diagnostics::RayLattice rays_;
  std::vector<Elevation> elevations_;
};

} // namespace keeler::cli
