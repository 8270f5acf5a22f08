#include "key_table.hpp"

#include "aggregates.hpp"
#include "collision_keys.hpp"
#include "material.hpp"
#include "moonlets.hpp"
#include "presets.hpp"
#include "start_pattern_keys.hpp"

#include <keeler/collision/restitution.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/scene/quality.hpp>

#include <fmt/format.h>

namespace keeler::scene {
namespace {

KeyRange up_to(double high) {
  return {.low = 0, .high = high, .low_open = true};
}

KeyRange from_0_to(double high) {
  return {.low = 0, .high = high};
}

// Ranges are wide, so that they exclude only wrong units: orbits of ten minutes to 20 years, patches up to a tenth of a
// ring's distance from its planet (1e8 m), materials up to the densest metals, motions up to 1000 times the shear
// across a particle, v_cut up to where a rebound would heat (it is at least v_cut / 1000), steps up to 0.3 orbit
// (without forces a drift of any length is exact), times up to where the shortest steps can no longer be counted. Every
// range is closed at both ends, so that a finite but absurd value cannot overflow during a run.

constexpr double max_orbits = 1e12;
constexpr double largest_whole = 0x1p63; // one above the largest integer of TOML

// All pairs are checked for overlap, and each moonlet adds columns to series.csv.
constexpr std::size_t max_placed_bodies = 1000;

std::vector<std::string> quality_names() {
  std::vector<std::string> names = {"custom"};
  for (const Quality& quality : qualities)
    names.emplace_back(quality.name);
  return names;
}

// Adds the keys of all laws of a registry, and the key by which a scene chooses one of them, which has their effect.
template<class Entry>
void add_laws(std::vector<Key>& keys, Key law, const std::string& section, const std::vector<Entry>& entries) {
  law.path = section + ".law";
  for (const Entry& entry : entries)
    law.choices.emplace_back(entry.name);
  keys.push_back(law);
  for (const Entry& entry : entries)
    for (Key key : entry.keys) {
      key.path = section + "." + key.path;
      key.only_with = {law.path, {entry.name}};
      key.effect = law.effect;
      keys.push_back(key);
    }
}

// Adds the keys of a force. Their paths and conditions are declared relative to its table.
void add_table(std::vector<Key>& keys, const std::string& table, const std::vector<Key>& own) {
  for (Key key : own) {
    key.path = table + "." + key.path;
    key.effect = KeyEffect::motion;
    if (!key.only_with.key.empty())
      key.only_with.key = table + "." + key.only_with.key;
    keys.push_back(key);
  }
}

std::vector<Key> patch_keys() {
  using enum KeyType;
  using enum KeyEffect;
  return {
      {.path = "title",
       .type = text,
       .fallback = "\"\"",
       .meaning = "a name for reports and pictures",
       .effect = output},
      {.path = "quality",
       .type = choice,
       .fallback = fmt::format("\"{}\"", default_quality),
       .meaning =
           "accuracy of steps, kicks and gravity where their keys are absent; custom: one step of 1e-3 orbit per "
           "kick, the tree",
       .choices = quality_names(),
       .effect = output},

      {.path = "planet.preset",
       .type = choice,
       .example = "\"saturn-a-ring\"",
       .meaning = "a location in a ring whose three frequencies are known",
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
       .alternatives = {"box.size_in_wavelengths"},
       .effect = start},
      {.path = "box.size_in_wavelengths",
       .type = pair,
       .example = "[4, 4]",
       .unit = "lambda_cr",
       .meaning = "the size in Toomre wavelengths 4 pi^2 G Sigma / kappa^2",
       .range = up_to(1e4),
       .alternatives = {"box.size"},
       .effect = start},

      {.path = "particles.optical_depth",
       .type = number,
       .example = "0.5",
       .unit = "1",
       .meaning = "geometric optical depth, which sets the number of particles",
       .range = up_to(100),
       .alternatives = {"particles.surface_density", "particles.count"},
       .effect = start},
      {.path = "particles.surface_density",
       .type = number,
       .example = "400.0",
       .unit = "kg/m^2",
       .meaning = "surface density, which sets the number of particles",
       .range = up_to(1e6),
       .alternatives = {"particles.optical_depth", "particles.count"},
       .effect = start},
      {.path = "particles.count",
       .type = integer,
       .example = "10000",
       .unit = "1",
       .meaning = "number of particles",
       .range = {.low = 1, .high = 1e9},
       .alternatives = {"particles.optical_depth", "particles.surface_density"},
       .effect = start},
      {.path = "particles.density",
       .type = number,
       .example = "600.0",
       .unit = "kg/m^3",
       .meaning = "density of the particles' material",
       .range = material_densities,
       .alternatives = {"particles.sizes.populations"},
       .effect = start},
      {.path = "particles.velocity_dispersion",
       .type = number,
       .fallback = "2.0",
       .unit = "mean r Omega",
       .meaning = "radial velocity dispersion at the start",
       .range = up_to(1000),
       .effect = start},
      {.path = "particles.seed",
       .type = integer,
       .fallback = "1",
       .unit = "1",
       .meaning = "seed of all random numbers",
       .range = from_0_to(largest_whole)},
  };
}

std::vector<Key> course_keys() {
  using enum KeyType;
  using enum KeyEffect;
  return {
      {.path = "start.from",
       .type = path,
       .example = "\"wakes.hdf\"",
       .meaning = "snapshot to start from, relative to the scene file; without [start] the patch is generated",
       .effect = start},
      {.path = "start.keep_fraction",
       .type = number,
       .fallback = "1.0",
       .unit = "1",
       .meaning = "fraction of its particles that is kept, drawn by a hash of their ids",
       .range = up_to(1),
       .effect = start,
       .former_name = "keep"},
      {.path = "start.keep_seed",
       .type = integer,
       .fallback = "1",
       .unit = "1",
       .meaning = "seed of this draw",
       .range = from_0_to(largest_whole),
       .effect = start},

      {.path = "time.step",
       .type = number,
       .fallback = "1e-3",
       .unit = "orbits",
       .meaning = "length of a step; \"auto\" adapts it to the state",
       .range = {.low = 1e-9, .high = 0.3},
       .choices = {"auto"}},
      {.path = "time.end",
       .type = number,
       .example = "3.0",
       .unit = "orbits",
       .meaning = "length of the run, rounded to whole kicks",
       .range = up_to(max_orbits),
       .effect = output},

      {.path = "output.series_every",
       .type = number,
       .fallback = "0.02",
       .unit = "orbits",
       .meaning = "time between rows of series.csv, rounded to whole kicks; 0: only one at the start",
       .range = from_0_to(max_orbits),
       .effect = output},
      {.path = "output.stress_every",
       .type = number,
       .fallback = "0.1",
       .unit = "orbits",
       .meaning = "time between rows of series.csv with the potential energy and the gravitational viscosity; 0: none",
       .range = from_0_to(max_orbits),
       .effect = output},
      {.path = "output.snapshot_every",
       .type = number,
       .fallback = "0.0",
       .unit = "orbits",
       .meaning = "time between snapshots, rounded to whole kicks; 0: only at start and end",
       .range = from_0_to(max_orbits),
       .effect = output},
      {.path = "output.checkpoint_every",
       .type = number,
       .fallback = "0.0",
       .unit = "orbits",
       .meaning = "time between checkpoints, rounded to whole kicks; 0: only those below, at the end and at a stop",
       .range = from_0_to(max_orbits),
       .effect = output},
      {.path = "output.checkpoint_every_minutes",
       .type = number,
       .fallback = "10.0",
       .unit = "minutes",
       .meaning = "wall time between checkpoints, besides those by checkpoint_every; 0: none by the clock",
       .range = from_0_to(1e9),
       .effect = output},

      {.path = "output.collisions.min_speed",
       .type = number,
       .fallback = "0.0",
       .unit = "m/s",
       .meaning = "contacts with at least this normal speed are logged",
       .range = from_0_to(1e6),
       .effect = output},
      {.path = "output.collisions.min_radius_sum",
       .type = number,
       .fallback = "0.0",
       .unit = "m",
       .meaning = "contacts of two particles whose radii sum up to at least this are logged",
       .range = from_0_to(1e7),
       .effect = output},
      {.path = "output.collisions.fraction",
       .type = number,
       .fallback = "1.0",
       .unit = "1",
       .meaning = "fraction of these contacts that is logged, drawn by a hash",
       .range = up_to(1),
       .effect = output,
       .former_name = "share"},
      {.path = "output.collisions.at_rest",
       .type = choice,
       .fallback = "\"omitted\"",
       .meaning = "contacts at rest: logged at each kick with the impulse that carries it, or not",
       .choices = {"omitted", "logged"},
       .effect = output},
  };
}

} // namespace

std::vector<Key> make_keys() {
  std::vector<Key> keys = patch_keys();
  const auto add = [&](const std::vector<Key>& more) { keys.insert(keys.end(), more.begin(), more.end()); };
  add_laws(
      keys,
      {.type = KeyType::choice, .example = "\"equal\"", .meaning = "size distribution", .effect = KeyEffect::start},
      "particles.sizes", particles::size_laws());
  add(start_pattern_keys());
  if (!particles::start_laws().empty())
    add_laws(keys,
             {.type = KeyType::choice,
              .example = fmt::format("\"{}\"", particles::start_laws().front().name),
              .meaning = "start of the calling program that places the particles",
              .effect = KeyEffect::start},
             "particles.start", particles::start_laws());
  add(aggregate_keys());
  add(moonlet_keys());
  add(collision_keys());
  add_laws(
      keys,
      {.type = KeyType::choice, .fallback = "\"bridges\"", .meaning = "law of the coefficient of normal restitution"},
      "collisions.restitution", collision::restitution_laws());
  add(restitution_keys());
  add(friction_keys());
  add_table(keys, "gravity", forces::gravity_keys());
  for (const forces::ForceEntry& force : forces::external_forces())
    add_table(keys, force.table, force.keys);
  add(course_keys());
  return keys;
}

std::vector<config::Section> make_sections() {
  std::vector<config::Section> sections = {
      {.path = "planet", .needed = true, .meaning = "it sets the orbit of the patch"},
      {.path = "box", .needed = true, .meaning = "it sets the size of the patch", .replaced_by = "start.from"},
      {.path = "particles",
       .needed = true,
       .meaning = "it sets the material of the patch",
       .replaced_by = "start.from"},
      {.path = "particles.sizes",
       .needed = true,
       .meaning = "it sets the sizes of the particles",
       .replaced_by = "start.from"},
      {.path = "particles.streamlines", .replaced_by = "start.from"},
      {.path = "particles.modes", .replaced_by = "start.from"},
      {.path = "moonlet", .replaced_by = "start.from", .repeated = true, .max_count = max_placed_bodies},
      {.path = "particles.density_step", .replaced_by = "start.from", .former_path = "particles.step"},
      {.path = "particles.wake", .replaced_by = "start.from"},
      {.path = "particles.aggregate", .replaced_by = "start.from", .repeated = true, .max_count = max_placed_bodies},
      {.path = "collisions", .defaults_if_absent = true},
      {.path = "collisions.restitution", .defaults_if_absent = true},
      {.path = "collisions.friction"},
      {.path = "gravity"},
      {.path = "start"},
      {.path = "time", .needed = true, .meaning = "it sets the length of the run"},
      {.path = "output", .defaults_if_absent = true},
      {.path = "output.collisions"},
  };
  if (!particles::start_laws().empty())
    sections.push_back({.path = "particles.start", .replaced_by = "start.from"});
  for (const forces::ForceEntry& force : forces::external_forces())
    sections.push_back({.path = force.table});
  return sections;
}

} // namespace keeler::scene
