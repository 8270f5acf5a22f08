// Options about observer, Sun and scattering law, of photometry and of render --lit.
#pragma once

#include <keeler/light/photometry.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::cli {

/// --law NAME[=VALUE] and --albedo VALUE.
struct LawOptions {
  std::string name = "callisto";
  double albedo = 0.5;

  void add_to(CLI::App& command, CLI::Option* needs = nullptr);
  light::SharedLaw law() const { return light::law_named(name, albedo); }
};

/// One sight, of a picture.
struct LitSight {
  double elevation = 20.0, azimuth = -60.0, phase = 60.0; ///< degrees
  std::optional<double> sun_elevation;                    ///< degrees; none: that of the observer
  int samples = 8;                                        ///< rays per pixel

  void add_to(CLI::App& command, CLI::Option* lit);
  /// Throws UsageError for a phase angle that the elevations do not allow.
  light::Sight sight() const;
};

/// A grid of sights, or the sights of a file or of a name.
struct SightGrid {
  std::vector<double> elevations, azimuths, sun_elevations, phases; ///< degrees
  std::string observations, geometry;

  void add_to(CLI::App& command);

  /// Returns the sights, azimuths fastest. Throws UsageError for a phase angle that elevations do not allow, with the
  /// line of the file if there is one.
  std::vector<light::Sight> sights() const;
};

/// Returns what is looked at: "3 snapshots of the orbits 2 to 3".
std::string patches_in_words(std::span<const Patch> patches);

} // namespace keeler::cli
