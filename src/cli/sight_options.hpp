// keeler analyze --elevation …: the ring as a star behind it shows it.
#pragma once

#include <keeler/diagnostics/occultation.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <vector>

namespace keeler {

struct SightOptions {
  std::vector<double> elevations, azimuths; ///< degrees
  std::size_t rays = 1000000;               ///< a snapshot and line of sight
  double footprint = 10.0;                  ///< m

  void add_to(CLI::App& command);
  bool asked() const { return !elevations.empty(); }
};

/// All azimuths of one elevation after the other. Without azimuths every 10° of half a turn.
class Sights {
public:
  Sights(const SightOptions& options, std::span<const Patch> patches);

  nlohmann::ordered_json json() const;
  void print() const;

private:
  struct Elevation {
    double degrees;
    std::vector<double> azimuths; // degrees
    std::vector<Occultation> looks;
  };

  RayLattice rays_;
  std::vector<Elevation> elevations_;
};

} // namespace keeler
