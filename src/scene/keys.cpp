#include <keeler/scene/keys.hpp>

#include "presets.hpp"

#include <keeler/collision/finders.hpp>
#include <keeler/core/words.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keeler {
namespace {

KeyRange above(double low) {
  return {.low = low, .low_open = true};
}

KeyRange at_least(double low) {
  return {.low = low};
}

KeyRange up_to(double high) {
  return {.low = 0, .high = high, .low_open = true};
}

// Ranges are wide, so that only slips of units lie outside: orbits of ten minutes to 20 years, patches up to a tenth of
// a ring's distance from its planet (1e8 m), materials up to the densest metals, radii of a micrometre to 1000 km,
// motions up to 1000 times the shear across a particle, v_cut up to where a rebound would heat (it is at least v_cut /
// 1000).
constexpr KeyRange radius_range = {.low = 1e-6, .high = 1e6};

std::vector<std::string> finder_names() {
  std::vector<std::string> names;
  for (const FinderEntry& finder : finder_table())
    names.emplace_back(finder.name);
  return names;
}

std::vector<Key> make_keys() {
  using enum KeyType;
  return {
      {.path = "title", .type = text, .fallback = "\"\"", .meaning = "a name for reports and pictures"},

      {.path = "planet.preset",
       .type = choice,
       .example = "\"saturn-a-ring\"",
       .meaning = "a place whose three frequencies are known",
       .choices = preset_names(),
       .alternatives = {"planet.orbital_frequency"}},
      {.path = "planet.orbital_frequency",
       .type = number,
       .example = "1.3175e-4",
       .unit = "rad/s",
       .meaning = "orbital frequency Omega",
       .range = {.low = 1e-8, .high = 1e-2},
       .alternatives = {"planet.preset"}},
      {.path = "planet.epicyclic_ratio",
       .type = number,
       .fallback = "1.0",
       .unit = "Omega",
       .meaning = "epicyclic frequency kappa",
       .range = {.low = 0.1, .high = 2, .low_open = true, .high_open = true},
       .only_with = {"planet.orbital_frequency", {}}},
      {.path = "planet.vertical_ratio",
       .type = number,
       .fallback = "1.0",
       .unit = "Omega",
       .meaning = "vertical frequency nu",
       .range = {.low = 0.1, .high = 100},
       .only_with = {"planet.orbital_frequency", {}}},

      {.path = "box.size",
       .type = pair,
       .example = "[245.0, 245.0]",
       .unit = "m",
       .meaning = "radial and azimuthal size of the patch",
       .range = up_to(1e7),
       .alternatives = {"box.size_in_wavelengths"}},
      {.path = "box.size_in_wavelengths",
       .type = pair,
       .example = "[4, 4]",
       .unit = "lambda_cr",
       .meaning = "the size in Toomre wavelengths 4 pi^2 G Sigma / kappa^2",
       .range = up_to(1e4),
       .alternatives = {"box.size"}},

      {.path = "particles.optical_depth",
       .type = number,
       .example = "0.5",
       .unit = "1",
       .meaning = "geometric optical depth, which sets the number of particles",
       .range = up_to(100),
       .alternatives = {"particles.surface_density", "particles.count"}},
      {.path = "particles.surface_density",
       .type = number,
       .example = "400.0",
       .unit = "kg/m^2",
       .meaning = "surface density, which sets the number of particles",
       .range = up_to(1e6),
       .alternatives = {"particles.optical_depth", "particles.count"}},
      {.path = "particles.count",
       .type = integer,
       .example = "10000",
       .unit = "1",
       .meaning = "number of particles",
       .range = {.low = 1, .high = 1e9},
       .alternatives = {"particles.optical_depth", "particles.surface_density"}},
      {.path = "particles.density",
       .type = number,
       .example = "600.0",
       .unit = "kg/m^3",
       .meaning = "density of the particles' material",
       .range = {.low = 1e-2, .high = 3e4}},
      {.path = "particles.velocity_dispersion",
       .type = number,
       .fallback = "2.0",
       .unit = "mean r Omega",
       .meaning = "radial velocity dispersion at the start",
       .range = up_to(1000)},
      {.path = "particles.seed",
       .type = integer,
       .fallback = "1",
       .unit = "1",
       .meaning = "seed of all random numbers",
       .range = at_least(0)},
      {.path = "particles.sizes.law",
       .type = choice,
       .example = "\"equal\"",
       .meaning = "how sizes are distributed",
       .choices = {"equal", "power", "file"}},
      {.path = "particles.sizes.radius",
       .type = number,
       .example = "1.0",
       .unit = "m",
       .meaning = "radius of every particle",
       .range = radius_range,
       .only_with = {"particles.sizes.law", {"equal"}}},
      {.path = "particles.sizes.exponent",
       .type = number,
       .example = "2.9",
       .unit = "1",
       .meaning = "q of the power law n(r) dr ~ r^-q dr",
       .range = {.low = -10, .high = 10},
       .only_with = {"particles.sizes.law", {"power"}}},
      {.path = "particles.sizes.min",
       .type = number,
       .example = "0.5",
       .unit = "m",
       .meaning = "smallest radius of the power law",
       .range = radius_range,
       .only_with = {"particles.sizes.law", {"power"}}},
      {.path = "particles.sizes.max",
       .type = number,
       .example = "5.0",
       .unit = "m",
       .meaning = "largest radius of the power law",
       .range = radius_range,
       .only_with = {"particles.sizes.law", {"power"}}},
      {.path = "particles.sizes.path",
       .type = path,
       .example = "\"radii.txt\"",
       .meaning = "file of radii in m, one a line, # starts a comment; relative to the scene file",
       .only_with = {"particles.sizes.law", {"file"}}},
      {.path = "particles.streamlines.waves",
       .type = integer,
       .example = "1",
       .unit = "1",
       .meaning = "waves in the box of a pattern in the eccentricity vectors: phases at the start are 2 pi n X / L_x",
       .range = {.low = 1, .high = 1000}},
      {.path = "particles.streamlines.bunching",
       .type = number,
       .example = "0.6",
       .unit = "1",
       .meaning = "q = (2 pi n / L_x) e of that pattern: streamlines bunch to 1 - q of their spacing once an orbit",
       .range = {.low = 0, .high = 0.9}},
      {.path = "particles.streamlines.inclination",
       .type = number,
       .fallback = "0.0",
       .unit = "mean r",
       .meaning = "inclination common to all particles, which swing up and down together; rising at the start",
       .range = {.low = 0, .high = 1000}},

      {.path = "collisions.finder",
       .type = choice,
       .fallback = "\"certified\"",
       .meaning = "how the times of contact are found",
       .choices = finder_names()},
      {.path = "collisions.elastic_below",
       .type = number,
       .fallback = "1e-2",
       .unit = "(r_i + r_j) Omega / 2",
       .meaning = "contacts slower than this bounce elastically, which ends inelastic collapse",
       .range = {.low = 0, .high = 100}},
      {.path = "collisions.restitution.law",
       .type = choice,
       .fallback = "\"bridges\"",
       .meaning = "how much normal speed a bounce keeps",
       .choices = {"bridges", "constant"}},
      {.path = "collisions.restitution.scale",
       .type = number,
       .fallback = "0.34",
       .unit = "1",
       .meaning = "c in min(1, c (v / 1 cm/s)^-0.234) (Bridges et al. 1984)",
       .range = above(0),
       .only_with = {"collisions.restitution.law", {"bridges"}}},
      {.path = "collisions.restitution.value",
       .type = number,
       .example = "0.5",
       .unit = "1",
       .meaning = "the constant coefficient",
       .range = {.low = 0, .high = 1},
       .only_with = {"collisions.restitution.law", {"constant"}}},

      {.path = "gravity.solver",
       .type = choice,
       .fallback = "\"tree\"",
       .meaning = "how accelerations are computed",
       .choices = {"direct", "tree", "fft", "mesh", "auto"}},
      {.path = "gravity.force_error",
       .type = number,
       .fallback = "2e-3",
       .unit = "rms force",
       .meaning = "rms error of the force asked for",
       .range = {.low = 1e-5, .high = 0.1},
       .only_with = {"gravity.solver", {"fft", "auto"}}},
      {.path = "gravity.mesh_spacing",
       .type = number,
       .fallback = "1.6",
       .unit = "mean distance",
       .meaning = "spacing of the mesh, in (particles an area)^-1/2",
       .range = {.low = 0.1, .high = 100},
       .only_with = {"gravity.solver", {"mesh"}}},
      {.path = "gravity.opening_angle",
       .type = number,
       .fallback = "0.6",
       .unit = "1",
       .meaning = "a cell is opened when its size exceeds this times its distance",
       .range = {.low = 0, .high = 1, .low_open = true},
       .only_with = {"gravity.solver", {"tree"}}},
      {.path = "gravity.images",
       .type = choice,
       .fallback = "\"periodic\"",
       .meaning = "periodic: all images, to infinity; rings: exactly image_rings rings, to compare with other codes",
       .choices = {"periodic", "rings"},
       .only_with = {"gravity.solver", {"direct", "tree"}}},
      {.path = "gravity.image_rings",
       .type = integer,
       .fallback = "1",
       .unit = "1",
       .meaning =
           "rings of boxes around the patch that are summed one by one (1 is 9 boxes, 2 is 25); at least 1 if periodic",
       .range = {.low = 0, .high = 10},
       .only_with = {"gravity.solver", {"direct", "tree"}}},
      {.path = "gravity.kick_every",
       .type = integer,
       .fallback = "1",
       .unit = "steps",
       .meaning = "drifts per kick",
       .range = {.low = 1, .high = 1000}},

      {.path = "start.from",
       .type = path,
       .example = "\"wakes.hdf\"",
       .meaning = "snapshot to start from, relative to the scene file; without [start] the patch is fresh"},

      {.path = "time.step",
       .type = number,
       .fallback = "1e-3",
       .unit = "orbits",
       .meaning = "length of a step",
       .range = {.low = 1e-9, .high = 0.1}},
      {.path = "time.end",
       .type = number,
       .example = "3.0",
       .unit = "orbits",
       .meaning = "length of the run, rounded to whole kicks",
       .range = above(0)},

      {.path = "output.snapshot_every",
       .type = number,
       .fallback = "0.0",
       .unit = "orbits",
       .meaning = "time between snapshots, rounded to whole kicks; 0: only at start and end",
       .range = at_least(0)},
      {.path = "output.checkpoint_every",
       .type = number,
       .fallback = "0.0",
       .unit = "orbits",
       .meaning = "time between checkpoints, rounded to whole kicks; 0: only at the end or a stop",
       .range = at_least(0)},
  };
}

} // namespace

bool KeyRange::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

bool KeyCondition::allows(const std::string& value) const {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::string KeyCondition::words() const {
  return values.empty() ? "" : fmt::format(" = \"{}\"", fmt::join(values, "\" or \""));
}

std::string KeyRange::words() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string below = fmt::format("{} {}", high_open ? "below" : "at most", figures(high));
  if (low == -infinity)
    return high == infinity ? "" : below;
  if (high == infinity)
    return low_open ? fmt::format("above {}", figures(low)) : fmt::format("from {} up", figures(low));
  return low_open ? fmt::format("above {} and {}", figures(low), below)
                  : fmt::format("from {} to {}", figures(low), figures(high));
}

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> keys = make_keys();
  return keys;
}

const std::vector<Section>& scene_sections() {
  static const std::vector<Section> sections = {
      {.path = "planet", .needed = true, .meaning = "it says where the patch orbits"},
      {.path = "box", .needed = true, .meaning = "it says how large the patch is", .replaced_by = "start.from"},
      {.path = "particles", .needed = true, .meaning = "it says what is in the patch", .replaced_by = "start.from"},
      {.path = "particles.sizes", .needed = true, .meaning = "it says how large they are", .replaced_by = "start.from"},
      {.path = "particles.streamlines", .replaced_by = "start.from"},
      {.path = "collisions"},
      {.path = "collisions.restitution"},
      {.path = "gravity"},
      {.path = "start"},
      {.path = "time", .needed = true, .meaning = "it says how long the run is"},
      {.path = "output"},
  };
  return sections;
}

const Key* find_key(const std::string& path) {
  const auto& keys = scene_keys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.path == path; });
  return found == keys.end() ? nullptr : &*found;
}

const Section* find_section(const std::string& path) {
  const auto& sections = scene_sections();
  const auto found = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.path == path; });
  return found == sections.end() ? nullptr : &*found;
}

std::string allowed_words(const Key& key) {
  const std::string range = key.range.words();
  const std::string suffix = range.empty() ? "" : " " + range;
  switch (key.type) {
  case KeyType::text:
    return "a string";
  case KeyType::path:
    return "the path of a file";
  case KeyType::choice:
    return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
  case KeyType::number:
    return "a number" + suffix;
  case KeyType::integer:
    return "a whole number" + suffix;
  case KeyType::pair:
    return "two numbers" + suffix;
  }
  return {};
}

} // namespace keeler
