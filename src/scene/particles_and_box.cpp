#include "particles_and_box.hpp"

#include "aggregates.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/layer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

// Throws UsageError if a value that follows from the key `from` is outside the range of the key `path`.
void require_possible(const std::string& location, const std::string& from, const std::string& path, double value) {
  assert(find_key(path));
  const Key& key = *find_key(path);
  if (!key.range.contains(value))
    config::fail_at(location,
                    fmt::format("{} makes {} {}, but it must be {} ({}, in {}); change {}", from, path,
                                format_number(value, 3), config::allowed_words(key), key.meaning, key.unit, from));
}

StreamlineSettings read_streamlines(const config::Settings& settings) {
  if (!settings.has("particles.streamlines"))
    return {};
  return {static_cast<int>(settings.integer("particles.streamlines.waves")),
          settings.number("particles.streamlines.bunching"), settings.number("particles.streamlines.inclination")};
}

// Upper limit of the sum of all amplitudes: at 1, streamlines may cross.
constexpr double max_bunching = 0.9;
constexpr std::size_t max_modes = 1000; // the position of each particle takes all of them

ModeSettings read_mode(const std::vector<double>& row, ModeSettings::Direction direction, const std::string& which) {
  assert(row.size() == 3);
  const auto require = [&](const char* what, double value, const KeyRange& range, const char* why) {
    if (!range.contains(value))
      throw UsageError(
          fmt::format("{} has {} {:g} (it must be {}{}); correct it", which, what, value, range.words(), why));
  };
  if (row[0] != std::floor(row[0]))
    throw UsageError(fmt::format("{} has {:g} waves (the box is periodic); give a whole number", which, row[0]));
  require("waves:", row[0], {.low = 1, .high = 1000}, "");
  require("the amplitude", row[1], {.low = 0, .high = max_bunching, .low_open = true}, ": at 1 streamlines cross");
  require("the phase", row[2], {.low = -360, .high = 360}, " degrees");
  return {direction, static_cast<int>(row[0]), row[1], row[2]};
}

void read_modes(config::Settings& settings, const std::string& name, const char* key, ModeSettings::Direction direction,
                std::vector<ModeSettings>& modes) {
  const std::string section = "particles.modes", path = fmt::format("{}.{}", section, key),
                    location = settings.location(path);
  const Parameters parameters = settings.parameters(section, name);
  const NumberRows& rows = parameters.rows(key);
  try {
    for (std::size_t k = 0; k < rows.size(); ++k)
      modes.push_back(read_mode(rows[k], direction, fmt::format("row {} of {}", k + 1, path)));
  } catch (const UsageError& fault) {
    config::fail_at(location, fault.what());
  }
}

std::vector<ModeSettings> read_modes(config::Settings& settings, const std::string& name) {
  std::vector<ModeSettings> modes;
  if (!settings.has("particles.modes"))
    return modes;
  const std::string location = settings.location("particles.modes");
  if (settings.has("particles.streamlines"))
    config::fail_at(
        location, "[particles.modes] cannot be combined with [particles.streamlines] (each sets the mean motion at the "
                  "start); keep one of the two");
  read_modes(settings, name, "outward", ModeSettings::Direction::outward, modes);
  read_modes(settings, name, "inward", ModeSettings::Direction::inward, modes);
  read_modes(settings, name, "standing", ModeSettings::Direction::standing, modes);
  if (modes.empty())
    config::fail_at(location, "[particles.modes] has no modes; add for example outward = [[1, 0.1, 0.0]]");
  if (modes.size() > max_modes)
    config::fail_at(
        location,
        fmt::format("[particles.modes] has {} modes (at most {}: the position of each particle takes all of them); "
                    "remove the weakest",
                    modes.size(), max_modes));
  double sum = 0.0;
  for (const ModeSettings& mode : modes)
    sum += mode.amplitude;
  if (!(sum <= max_bunching))
    config::fail_at(location,
                    fmt::format("the amplitudes of [particles.modes] sum up to {:.3g} (at 1 streamlines cross); lower "
                                "them to {} in all",
                                sum, max_bunching));
  return modes;
}

// Throws UsageError if `waves` waves in the box are shorter than a particle; `what` names their key.
void require_long(const Scene& scene, int waves, const std::string& location, const std::string& what) {
  assert(waves > 0 && scene.size_x > 0.0);
  const double across = 2.0 * scene.particles.sizes.largest, wavelength = scene.size_x / waves;
  if (!(wavelength >= across))
    config::fail_at(
        location, fmt::format("{} has waves of {} m, shorter than the largest particle ({} m across); give at most {} "
                              "in the box",
                              what, format_number(wavelength, 4), format_number(across, 4),
                              std::max(1.0, std::floor(scene.size_x / across))));
}

// Precondition: the box is known.
void require_long_waves(const Scene& scene, const config::Settings& settings) {
  const ParticleSettings& particles = scene.particles;
  if (particles.streamlines.bunching > 0.0)
    require_long(scene, particles.streamlines.waves, settings.location("particles.streamlines.waves"),
                 "particles.streamlines");
  const char* const directions[] = {"outward", "inward", "standing"};
  for (const ModeSettings& mode : particles.modes) {
    const std::string key = std::string("particles.modes.") + directions[static_cast<std::size_t>(mode.direction)];
    require_long(scene, mode.waves, settings.location(key), key);
  }
}

void read_step(const Scene& scene, const config::Settings& settings, DensityPattern& pattern) {
  const std::vector<double> between = settings.numbers("particles.density_step.between");
  const double edge = 0.5 * scene.size_x;
  if (!(between[0] < between[1] && between[0] >= -edge && between[1] <= edge && between[1] - between[0] < scene.size_x))
    config::fail_at(
        settings.location("particles.density_step.between"),
        fmt::format(
            "particles.density_step.between is [{}, {}] (it must be two rising x within the box, from {} to {}, and "
            "not all of it); correct it",
            format_number(between[0]), format_number(between[1]), format_number(-edge), format_number(edge)));
  pattern.low = between[0];
  pattern.high = between[1];
  pattern.factor = settings.number("particles.density_step.factor");
}

// Rounds the wave vector so that whole waves fit the periodic box along both sides.
void read_wake(Scene& scene, config::Settings& settings, DensityPattern& pattern) {
  const double wavelength = settings.number("particles.wake.wavelength"),
               pitch = settings.number("particles.wake.pitch") * pi / 180.0;
  const double waves_x = std::round(scene.size_x * std::cos(pitch) / wavelength),
               waves_y = std::round(scene.size_y * std::sin(pitch) / wavelength);
  const std::string location = settings.location("particles.wake.wavelength");
  if (waves_x == 0.0 && waves_y == 0.0)
    config::fail_at(
        location,
        fmt::format("particles.wake.wavelength = {} is too long (no wave fits the box of {} m x {} m); lower "
                    "it or enlarge the box",
                    format_number(wavelength), format_number(scene.size_x, 4), format_number(scene.size_y, 4)));
  if (!(wavelength >= 2.0 * scene.particles.sizes.largest))
    config::fail_at(
        location,
        fmt::format("particles.wake.wavelength = {} is shorter than the largest particle ({} m across); raise "
                    "it",
                    format_number(wavelength), format_number(2.0 * scene.particles.sizes.largest, 4)));
  constexpr double max_waves = 1e9;
  if (!(waves_x <= max_waves && waves_y <= max_waves))
    config::fail_at(location,
                    fmt::format("particles.wake.wavelength = {} is too short (the box would hold {} waves); raise it",
                                format_number(wavelength), format_number(std::max(waves_x, waves_y), 3)));
  pattern.contrast = settings.number("particles.wake.contrast");
  pattern.waves_x = static_cast<int>(waves_x);
  pattern.waves_y = static_cast<int>(waves_y);
  if (std::fabs(pattern.wavelength() / wavelength - 1.0) > 1e-9 ||
      std::fabs(pattern.pitch() - pitch * 180.0 / pi) > 1e-9)
    scene.notices.push_back(fmt::format(
        "the wake has a wavelength of {} m and a pitch of {} degrees ({} x {} waves fit "
        "the box)",
        format_number(pattern.wavelength(), 4), format_number(pattern.pitch(), 4), pattern.waves_x, pattern.waves_y));
  settings.resolve("particles.wake.wavelength", pattern.wavelength());
  settings.resolve("particles.wake.pitch", pattern.pitch());
}

void read_pattern(Scene& scene, config::Settings& settings) {
  DensityPattern pattern{.size_x = scene.size_x, .size_y = scene.size_y};
  if (settings.has("particles.density_step"))
    read_step(scene, settings, pattern);
  if (settings.has("particles.wake"))
    read_wake(scene, settings, pattern);
  scene.particles.pattern = pattern;
}

std::optional<StartSettings> read_start(config::Settings& settings, const std::string& name) {
  if (!settings.has("particles.start"))
    return {};
  for (const char* const other : {"streamlines", "modes", "step", "wake", "aggregate"})
    if (const std::string path = std::string("particles.") + other; settings.has(path))
      config::fail_at(
          settings.location(path),
          fmt::format("{} cannot be combined with particles.start (each says where particles are at the start); "
                      "remove one of the two",
                      path));
  const std::string law = settings.text("particles.start.law");
  const auto entry = std::ranges::find(particles::start_laws(), law, &particles::StartEntry::name);
  assert(entry != particles::start_laws().end());
  return StartSettings{&*entry, settings.parameters("particles.start", name)};
}

// The key that sets the amount of material, and the optical depth that it asks for (0 if it is a count).
struct Amount {
  std::string key;
  double optical_depth = 0.0;
};

Amount read_amount(const config::Settings& settings, const ParticleSettings& particles) {
  if (settings.has("particles.optical_depth"))
    return {"particles.optical_depth", settings.number("particles.optical_depth")};
  if (settings.has("particles.surface_density"))
    return {"particles.surface_density", settings.number("particles.surface_density") /
                                             surface_density_per_depth(particles.sizes, particles.density)};
  return {"particles.count"};
}

void read_box(Scene& scene, config::Settings& settings, const Amount& amount) {
  const std::string wavelengths = "box.size_in_wavelengths";
  const bool by_wavelength = settings.has(wavelengths);
  const std::string key = by_wavelength ? wavelengths : "box.size";
  const std::string location = settings.location(key);
  std::vector<double> size = settings.numbers(key);
  if (by_wavelength) {
    if (amount.key == "particles.count")
      config::fail_at(
          location,
          "box.size_in_wavelengths cannot be combined with particles.count (the wavelength follows from the surface "
          "density, and with a count this follows from the box); give box.size or particles.optical_depth");
    const double surface_density =
        amount.optical_depth * surface_density_per_depth(scene.particles.sizes, scene.particles.density);
    const double wavelength = critical_wavelength(surface_density, scene.planet);
    for (double& length : size)
      length *= wavelength;
    settings.resolve("box.size", size, wavelengths);
  }
  for (const double length : size)
    require_possible(location, key, "box.size", length);
  if (!(std::max(size[0], size[1]) <= max_aspect_ratio * std::min(size[0], size[1])))
    config::fail_at(location,
                    fmt::format("the box of {} m x {} m is more than {:g} times as long as wide (it would need too "
                                "many images of its short side); make it squarer",
                                format_number(size[0], 4), format_number(size[1], 4), max_aspect_ratio));
  scene.size_x = size[0];
  scene.size_y = size[1];
  const double diameter = 2.0 * scene.particles.sizes.largest;
  if (!(std::min(size[0], size[1]) >= diameter))
    config::fail_at(
        location,
        fmt::format("the box of {:.4g} m x {:.4g} m is smaller than a particle (the largest is {:.4g} m across); "
                    "enlarge the box or lower the radius",
                    size[0], size[1], diameter));
}

void read_count(Scene& scene, config::Settings& settings, const Amount& amount) {
  const std::string location = settings.location(amount.key);
  ParticleSettings& particles = scene.particles;
  double count = 0.0;
  if (amount.key == "particles.count") {
    count = static_cast<double>(settings.integer(amount.key));
  } else {
    const double particle_area = pi * particles.sizes.mean_power(2);
    count = std::round(amount.optical_depth * scene.size_x * scene.size_y / particle_area);
  }
  if (!(count >= 1.0 && count <= 1e9))
    config::fail_at(location,
                    fmt::format("{} with this box makes {:.3g} particles (a run takes 1 to 1e9); change the box or {}",
                                amount.key, count, amount.key));
  particles.count = static_cast<std::size_t>(count);
  require_possible(location, amount.key, "particles.optical_depth", scene.optical_depth());
  require_possible(location, amount.key, "particles.surface_density", scene.surface_density());
  if (amount.key != "particles.count")
    settings.resolve("particles.count", static_cast<std::int64_t>(particles.count), amount.key);
}

// Checks the mid-plane filling of a Gaussian layer of the scene's height (largest_filling in scene/layer.hpp).
void check_filling(Scene& scene, const std::string& location) {
  assert(scene.particles.count > 0);
  const ParticleSettings& particles = scene.particles;
  const double nu = scene.planet.frequencies.nu, depth = scene.optical_depth(), bunched = scene.bunched_optical_depth();
  const LayerSizes sizes = particles.layer_sizes();
  const double filling = midplane_filling(bunched, sizes, particles.velocity_dispersion, nu);
  if (!(filling <= refused_filling)) {
    const double hot = dispersion_for_filling(bunched, sizes, nu, refused_filling);
    const double thin = optical_depth_for_filling(sizes, particles.velocity_dispersion, nu, refused_filling);
    config::fail_at(location,
                    fmt::format("too dense (the mid-plane filling factor would be {:.2f}, and at most {:.2f} can be "
                                "placed without overlap); raise velocity_dispersion to at least {:.2f} or lower the "
                                "optical depth from {:.3g} to at most {:.2f}{}",
                                filling, refused_filling, std::ceil(hot * 100.0) / 100.0, depth,
                                std::floor(thin * depth / bunched * 100.0) / 100.0,
                                !(bunched > depth)             ? ""
                                : !particles.pattern.uniform() ? " or even out the step or the wake"
                                : particles.modes.empty()      ? " or lower the bunching"
                                                               : " or lower the amplitudes of the modes"));
  }
  if (filling > largest_filling)
    scene.notices.push_back(
        fmt::format("the start has a flat-topped layer with a mid-plane filling factor of {:.2f}: a "
                    "Gaussian layer of this optical depth and height would have {:.2f}",
                    largest_filling, filling));
}

} // namespace

void read_particles_and_box(Scene& scene, config::Settings& settings, const std::string& name) {
  assert(scene.planet.orbital_frequency > 0.0);
  ParticleSettings& particles = scene.particles;
  particles.sizes = make_law(particles::size_laws(), "particles.sizes", settings, name);
  try {
    require_consistent(particles.sizes);
  } catch (const UsageError& fault) {
    config::fail_at(settings.location("particles.sizes.law"), fmt::format("particles.sizes: {}", fault.what()));
  }
  particles.density = particles.sizes.density ? particles.sizes.mean_density : settings.number("particles.density");
  particles.velocity_dispersion = settings.number("particles.velocity_dispersion");
  particles.seed = static_cast<std::uint64_t>(settings.integer("particles.seed"));
  particles.start = read_start(settings, name);
  particles.streamlines = read_streamlines(settings);
  particles.modes = read_modes(settings, name);
  const Amount amount = read_amount(settings, particles);
  read_box(scene, settings, amount);
  require_long_waves(scene, settings);
  read_pattern(scene, settings);
  const std::string location = settings.location(amount.key); // before read_count() resolves it
  read_count(scene, settings, amount);
  particles.aggregates = read_aggregates(settings, name, particles);
  if (!particles.start)
    check_filling(scene, location);
}

} // namespace keeler::scene
