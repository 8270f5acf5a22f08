#include "sight_options.hpp"

#include "common_options.hpp"
#include "print.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <array>
#include <cassert>

namespace keeler::cli {
namespace {

constexpr double degree = pi / 180.0;
constexpr double min_elevation = 0.1; // degrees: rays cross 600 m of ring per metre of its thickness
constexpr int default_azimuths = 18;  // every 10° of half a turn; the other half is equivalent
constexpr double max_rays = 1e9;

nlohmann::ordered_json maybe(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string known(const std::optional<double>& value, int digits) {
  return value ? format_number(*value, digits) : "unknown";
}

} // namespace

void SightOptions::add_to(CLI::App& command) {
  CLI::Option* const elevation =
      command
          .add_option("--elevation", elevations,
                      "cast rays at these angles above the ring plane (degrees, separated by commas)")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(number_between(min_elevation, 90.0, "an elevation"));
  command
      .add_option("--azimuth", azimuths,
                  "angles from the radius to the orbital motion (degrees, separated by commas; default: every 10)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(number_between(-360.0, 360.0, "an azimuth"))
      ->needs(elevation);
  command.add_option("--rays", rays, "rays per line of sight and snapshot (default: 1000000)")
      ->transform(whole_number_between(1, max_rays, "a number of rays"))
      ->needs(elevation);
  command.add_option("--footprint", footprint, "side of the areas for the flicker, in m (default: 10)")
      ->check(positive_number())
      ->needs(elevation);
}

Sights::Sights(const SightOptions& options, std::span<const Patch> patches)
    : rays_(patches.front().box, options.rays, options.footprint) {
  assert(!patches.empty() && options.requested());
  std::vector<double> azimuths = options.azimuths;
  if (azimuths.empty())
    for (int k = 0; k < default_azimuths; ++k)
      azimuths.push_back(180.0 / default_azimuths * k);
  for (const double elevation : options.elevations) {
    Elevation of_elevation{elevation, azimuths, {}};
    for (const double azimuth : azimuths)
      of_elevation.sights.push_back(occultation(patches, rays_, {elevation * degree, azimuth * degree}));
    elevations_.push_back(std::move(of_elevation));
  }
}

nlohmann::ordered_json Sights::json() const {
  nlohmann::ordered_json json;
  json["rays"] = rays_.size();
  json["footprint_m"] = std::array{rays_.footprint_x(), rays_.footprint_y()};
  json["footprints"] = rays_.footprints();
  json["elevations"] = nlohmann::ordered_json::array();
  for (const Elevation& e : elevations_) {
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < e.sights.size(); ++k) {
      const diagnostics::Occultation& o = e.sights[k];
      entries.push_back({{"azimuth_degrees", e.azimuths[k]},
                         {"transmission", *o.transmission.value},
                         {"transmission_error", o.ray_error},
                         {"transmission_scatter", maybe(o.transmission.scatter)},
                         {"normal_optical_depth", maybe(o.normal_optical_depth)},
                         {"normal_optical_depth_error", maybe(o.normal_optical_depth_error)},
                         {"flicker_variance", o.flicker.variance},
                         {"flicker_skewness", maybe(o.flicker.skewness)},
                         {"flicker_kurtosis", maybe(o.flicker.kurtosis)}});
    }
    const auto asymmetry = azimuthal_asymmetry(e.sights);
    json["elevations"].push_back(
        {{"elevation_degrees", e.degrees},
         {"azimuthal_asymmetry", asymmetry ? nlohmann::ordered_json(asymmetry->amplitude) : nullptr},
         {"brightest_azimuth_degrees",
          asymmetry ? nlohmann::ordered_json(asymmetry->brightest_azimuth / degree) : nullptr},
         {"azimuths", entries}});
  }
  return json;
}

void Sights::print() const {
  cli::print("lines of sight       {} rays, footprints of {} x {} m\n", rays_.size(),
             format_number(rays_.footprint_x(), 3), format_number(rays_.footprint_y(), 3));
  for (const Elevation& e : elevations_) {
    for (std::size_t k = 0; k < e.sights.size(); ++k) {
      const diagnostics::Occultation& o = e.sights[k];
      cli::print("  B {:<5} phi {:<5} T {:.4f} +- {:.4f}, normal optical depth {}; flicker: variance {}, skewness {}, "
                 "kurtosis {}\n",
                 format_number(e.degrees, 3), format_number(e.azimuths[k], 3), *o.transmission.value, o.ray_error,
                 known(o.normal_optical_depth, 4), format_number(o.flicker.variance, 3), known(o.flicker.skewness, 3),
                 known(o.flicker.kurtosis, 3));
    }
    if (const auto asymmetry = azimuthal_asymmetry(e.sights))
      cli::print("  B {:<5} azimuthal asymmetry {:.3g}, brightest at {} degrees\n", format_number(e.degrees, 3),
                 asymmetry->amplitude, format_number(asymmetry->brightest_azimuth / degree, 4));
  }
}

} // namespace keeler::cli
