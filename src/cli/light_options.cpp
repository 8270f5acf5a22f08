#include "light_options.hpp"

#include "common_options.hpp"
#include "observation_columns.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::cli {
namespace {

constexpr double from_degrees = pi / 180.0;
constexpr double lowest_sight = 0.1; // degrees, as of analyze --elevation
constexpr double usual_phase = 6.0;  // degrees: the largest that is seen from Earth

// Sights with names, each from a source that gives its angles.
struct NamedSights {
  const char* name;
  std::vector<double> elevations, phases; // degrees; the Sun has the elevation of the observer
};

const std::vector<NamedSights>& named_sights() {
  static const std::vector<NamedSights> all = {
      // Hubble Space Telescope: elevations near which Poulet et al. (2002, Icarus 158, 224) and French et al. (2007,
      // PASP
      // 119, 623) have phase curves from 0 to 6 degrees, after Salo & French (2010, Icarus 210, 785)
      {"hubble-10", {10.0}, {0.3, 0.5, 1.0, 2.0, 4.0, 6.0}},
      {"hubble-23", {23.0}, {0.02, 0.1, 0.3, 0.5, 1.0, 2.0, 4.0, 6.0}},
      // the range of elevations of these images (French et al. 2005, BAAS 37, 671: 3 < |B| < 26), at the largest phase
      {"hubble-tilt", {3.0, 4.5, 10.0, 15.0, 20.0, 23.0, 26.0}, {6.0}},
  };
  return all;
}

CLI::Validator elevation_range() {
  const auto refusal = [](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return *end == '\0' && end != text.c_str() && std::fabs(value) >= lowest_sight && std::fabs(value) <= 90.0
               ? std::string()
               : "'" + text + "' is not an elevation from 0.1 to 90 degrees, or from -90 to -0.1";
  };
  return CLI::Validator(refusal, "");
}

CLI::Option* add_angles(CLI::App& command, const char* name, std::vector<double>& angles, const char* meaning) {
  return command.add_option(name, angles, meaning)->delimiter(',')->allow_extra_args(false)->type_name("DEGREES,...");
}

std::vector<double> radians(std::vector<double> degrees) {
  for (double& angle : degrees)
    angle *= from_degrees;
  return degrees;
}

light::Sight sight_of_degrees(double elevation_degrees, double azimuth, double sun_elevation, double phase) {
  return light::sight_at_phase({elevation_degrees * from_degrees, azimuth * from_degrees}, sun_elevation * from_degrees,
                               phase * from_degrees);
}

// Reads a table of observations: elevation, azimuth or longitude, sun_elevation, phase; in degrees.
std::vector<light::Sight> sights_of_file(const std::string& file) {
  const ObservationColumns table(file);
  const std::vector<double>&elevations = table.required("elevation"), &suns = table.required("sun_elevation"),
        &phases = table.required("phase");
  const std::vector<double> azimuths = table.azimuths();
  std::vector<light::Sight> sights;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const double angle : {elevations[row], suns[row]})
      if (!(std::fabs(angle) >= lowest_sight && std::fabs(angle) <= 90.0))
        table.fail(row, fmt::format("the elevation {:g} is not from 0.1 to 90 degrees or from -90 to -0.1; correct it",
                                    angle));
    try {
      sights.push_back(sight_of_degrees(elevations[row], azimuths[row], suns[row], phases[row]));
    } catch (const UsageError& error) {
      table.fail(row, error.what());
    }
  }
  return sights;
}

} // namespace

std::string patches_in_words(std::span<const Patch> patches) {
  const std::string count = pluralize(patches.size(), "snapshot");
  const std::string first = format_number(patches.front().time_orbits, 4),
                    last = format_number(patches.back().time_orbits, 4);
  return first == last ? fmt::format("{} of orbit {}", count, first)
                       : fmt::format("{} of the orbits {} to {}", count, first, last);
}

void LawOptions::add_to(CLI::App& command, CLI::Option* needs) {
  std::string words;
  for (const light::LawEntry& entry : light::law_entries())
    words += fmt::format("{}{}{}", words.empty() ? "" : "|", entry.name,
                         *entry.parameter ? fmt::format("[={}]", entry.parameter) : "");
  CLI::Option* const law =
      command.add_option("--law", name, "scattering law of the particles (default: callisto)")->type_name(words);
  CLI::Option* const of_law = command.add_option("--albedo", albedo, "their single scattering albedo (default: 0.5)")
                                  ->check(positive_number(1.0));
  if (needs) {
    law->needs(needs);
    of_law->needs(needs);
  }
}

void LitSight::add_to(CLI::App& command, CLI::Option* lit) {
  const auto add = [&](const char* name, auto& angle, const char* meaning) {
    return command.add_option(name, angle, meaning)->type_name("DEGREES")->needs(lit);
  };
  add("--elevation", elevation, "elevation of the observer; below 0: the other face (default: 20)")
      ->check(elevation_range());
  add("--azimuth", azimuth, "azimuth of the observer, from the radius to the orbital motion (default: -60)")
      ->check(number_between(-360.0, 360.0, "an azimuth"));
  add("--sun-elevation", sun_elevation, "elevation of the Sun (default: that of the observer)")
      ->check(elevation_range());
  add("--phase", phase, "phase angle (default: 60)")->check(number_between(0.0, 180.0, "a phase angle"));
  command.add_option("--samples", samples, "rays per pixel (default: 8)")
      ->transform(whole_number_between(1, 10000, "a number of rays"))
      ->needs(lit);
}

light::Sight LitSight::sight() const {
  return sight_of_degrees(elevation, azimuth, sun_elevation.value_or(elevation), phase);
}

void SightGrid::add_to(CLI::App& command) {
  CLI::Option* const elevation_option =
      add_angles(command, "--elevation", elevations,
                 "elevations of the observer above the ring plane; below 0: the other face")
          ->check(elevation_range());
  CLI::Option* const azimuth =
      add_angles(command, "--azimuth", azimuths,
                 "azimuths of the observer, from the radius to the orbital motion (default: every 10 in half a turn)")
          ->check(number_between(-360.0, 360.0, "an azimuth"));
  CLI::Option* const sun =
      add_angles(command, "--sun-elevation", sun_elevations, "elevations of the Sun (default: that of the observer)")
          ->check(elevation_range())
          ->needs(elevation_option);
  CLI::Option* const phase = add_angles(command, "--phase", phases, "phase angles (default: 6)")
                                 ->check(number_between(0.0, 180.0, "a phase angle"))
                                 ->needs(elevation_option);
  CLI::Option* const file =
      command
          .add_option(
              "--observations", observations,
              "a table of observations: columns elevation, azimuth or longitude, sun_elevation, phase, in degrees")
          ->type_name("FILE");
  std::vector<std::string> names;
  for (const NamedSights& one : named_sights())
    names.emplace_back(one.name);
  CLI::Option& name = one_of(command.add_option("--geometry", geometry, "sights of published observations"), names);
  for (CLI::Option* const option : {elevation_option, azimuth, sun, phase})
    file->excludes(option);
  for (CLI::Option* const option : {elevation_option, sun, phase, file})
    name.excludes(option);
}

std::vector<light::Sight> SightGrid::sights() const {
  if (!observations.empty())
    return sights_of_file(observations);
  std::vector<double> of_observer = elevations, of_phase = phases, of_azimuth = azimuths;
  for (const NamedSights& one : named_sights())
    if (geometry == one.name)
      of_observer = one.elevations, of_phase = one.phases;
  if (of_observer.empty())
    throw UsageError("there is no sight; give --elevation, --observations or --geometry");
  if (of_phase.empty())
    of_phase = {usual_phase};
  if (of_azimuth.empty())
    for (int k = 0; k < 18; ++k)
      of_azimuth.push_back(10.0 * k);
  return light::sight_grid(radians(of_observer), radians(sun_elevations), radians(of_phase), radians(of_azimuth));
}

} // namespace keeler::cli
