#include <keeler/scene/scene.hpp>

#include "checks.hpp"
#include "moonlets.hpp"
#include "overrides.hpp"
#include "particles_and_box.hpp"
#include "placed_bodies.hpp"
#include "presets.hpp"
#include "quality.hpp"
#include "settings.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/scene/derived.hpp>
#include <keeler/scene/examples.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/resting_choice.hpp>
#include <keeler/scene/warnings.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

PlanetSettings read_planet(Settings& settings) {
  PlanetSettings planet;
  if (settings.has("planet.preset")) {
    planet = find_preset(settings.text("planet.preset"));
    settings.resolve("planet.orbital_frequency", planet.orbital_frequency, "planet.preset");
    settings.resolve("planet.epicyclic_ratio", planet.frequencies.kappa);
    settings.resolve("planet.vertical_ratio", planet.frequencies.nu);
  } else {
    planet.orbital_frequency = settings.number("planet.orbital_frequency");
    planet.frequencies = {settings.number("planet.epicyclic_ratio"), settings.number("planet.vertical_ratio")};
  }
  return planet;
}

std::optional<Friction> read_friction(const Settings& settings) {
  if (!settings.has("collisions.friction"))
    return {};
  const std::string coefficient = "collisions.friction.coefficient";
  return Friction{settings.number("collisions.friction.tangential_restitution"),
                  settings.is_word(coefficient) ? Friction::unlimited : settings.number(coefficient)};
}

CollisionSettings read_collisions(Settings& settings, const std::string& name) {
  CollisionSettings collisions;
  collisions.finder = settings.text("collisions.finder");
  collisions.elastic_below = settings.number("collisions.elastic_below");
  collisions.restitution = make_law(restitution_laws(), "collisions.restitution", settings, name);
  if (const double largest = settings.number("collisions.restitution.largest"); largest < 1.0)
    collisions.restitution = [law = collisions.restitution, largest](const Impact& impact) {
      return std::min(largest, law(impact));
    };
  collisions.friction = read_friction(settings);
  return collisions;
}

// `size_x`: of the box; 0 where a file holds it, and the solver will see.
std::optional<GravitySettings> read_gravity(Settings& settings, const std::string& name, double size_x) {
  if (!settings.has("gravity"))
    return {};
  const GravitySettings gravity = gravity_settings(settings.parameters("gravity", name));
  if (size_x > 0.0 && gravity.solver == GravitySettings::Solver::axisymmetric)
    if (const std::string fault = radial_mesh_fault(size_x, gravity.shortest_wavelength); !fault.empty())
      fail_at(settings.place("gravity.shortest_wavelength"), fault);
  return gravity;
}

// Where the box is known a force is made as a run makes it, to see what it says to its values.
std::vector<ForceSettings> read_external_forces(const Scene& scene, Settings& settings, const std::string& name) {
  const ForceContext context{.masses = {},
                             .box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0},
                             .orbital_frequency = scene.planet.orbital_frequency};
  std::vector<ForceSettings> forces;
  for (const ForceEntry& entry : external_forces()) {
    if (!settings.has(entry.table))
      continue;
    forces.push_back({&entry, settings.parameters(entry.table, name)});
    try {
      if (scene.size_x > 0.0 && entry.check)
        entry.check(forces.back().parameters, scene.size_x);
      if (scene.size_x > 0.0)
        entry.make(forces.back().parameters, context);
    } catch (const UsageError& fault) {
      fail_at(settings.place(entry.table), fault.what());
    }
  }
  return forces;
}

// A time in orbits as steps: the nearest multiple of the kick interval, but at least one unless the time is 0.
std::int64_t whole_kicks(Scene& scene, Settings& settings, const std::string& key) {
  const double orbits = settings.number(key);
  const std::int64_t per_kick = scene.kick_interval();
  const double interval = scene.time.step * static_cast<double>(per_kick);
  const double kicks = orbits / interval;
  if (!(kicks < 1e15))
    fail_at(settings.place(key),
            fmt::format("{} = {} is too long (a step of {} makes more than 1e15 steps); lower it or "
                        "raise time.step",
                        key, orbits, scene.time.step));
  if (orbits == 0.0)
    return 0;
  std::int64_t whole = std::max<std::int64_t>(1, std::llround(kicks));
  if (whole > 1 && !find_key(key)->range.contains(static_cast<double>(whole) * interval))
    --whole; // the resolved scene must be one
  const std::int64_t steps = whole * per_kick;
  if (std::fabs(kicks - static_cast<double>(whole)) > 1e-9 * kicks) {
    const double rounded = static_cast<double>(steps) * scene.time.step;
    const std::string kicks_every = scene.time.automatic ? "longest steps"
                                    : per_kick > 1       ? fmt::format("kicks, one every {} steps", per_kick)
                                                         : "steps";
    if (settings.given(key))
      scene.notices.push_back(fmt::format("{} = {} is rounded to {:.12g} orbits (whole {} of {} orbits)", key, orbits,
                                          rounded, kicks_every, scene.time.automatic ? interval : scene.time.step));
    settings.resolve(key, rounded);
  }
  return steps;
}

// Searches for contacts slow down with the oscillations that a step holds: 3 times at one, 15 times at one and a half,
// beyond all bounds at two (docs/dev/drift.md).
void refuse_many_oscillations(const Scene& scene, const Settings& settings) {
  const Frequencies& frequencies = scene.planet.frequencies;
  const double fastest = std::max(frequencies.kappa, frequencies.nu);
  if (oscillations_a_step(scene) > max_oscillations)
    fail_at(settings.place("time.step"),
            fmt::format("time.step = {} holds {} {} oscillations of {} Omega (searches for contacts would not end in "
                        "reasonable time beyond 1.5); let it be {} orbits at most",
                        format_number(scene.time.step), format_number(oscillations_a_step(scene), 3),
                        frequencies.nu < frequencies.kappa ? "radial" : "vertical", format_number(fastest),
                        format_number(few_oscillations / fastest, 3)));
}

void read_times(Scene& scene, Settings& settings) {
  scene.time.automatic = settings.is_word("time.step");
  scene.time.step = scene.time.automatic ? 1.0 / TimeSettings::ticks_per_orbit : settings.number("time.step");
  if (scene.time.automatic && scene.gravity && scene.gravity->kick_every != 1)
    fail_at(settings.place("gravity.kick_every"),
            "gravity.kick_every cannot stand beside time.step = \"auto\" (which sets the kick interval); remove one of "
            "the two");
  scene.time.end_step = whole_kicks(scene, settings, "time.end");
  scene.output.series_every = whole_kicks(scene, settings, "output.series_every");
  scene.output.stress_every = whole_kicks(scene, settings, "output.stress_every");
  scene.output.snapshot_every = whole_kicks(scene, settings, "output.snapshot_every");
  scene.output.checkpoint_every = whole_kicks(scene, settings, "output.checkpoint_every");
  scene.output.checkpoint_every_minutes = settings.number("output.checkpoint_every_minutes");
}

std::optional<ContactLogSettings> read_contact_log(Settings& settings) {
  if (!settings.has("output.collisions"))
    return {};
  return ContactLogSettings{settings.number("output.collisions.min_speed"),
                            settings.number("output.collisions.min_radius_sum"),
                            settings.number("output.collisions.share")};
}

void read_start(Scene& scene, Settings& settings, const std::string& name) {
  scene.start_from = settings.file_path("start.from", name);
  scene.start_keep = settings.number("start.keep");
  scene.start_keep_seed = static_cast<std::uint64_t>(settings.integer("start.keep_seed"));
}

enum class Purpose { start, table, go_on }; // table: the scene's particles are placeholders

// A file or a table of particles decides later. A stored scene of a program that did not know the key bounced all
// contacts.
void read_resting_contacts(Scene& scene, Settings& settings, Purpose purpose) {
  const char* const key = "gravity.resting_contacts";
  if (!scene.gravity || !settings.has(key) || settings.text(key) != "auto")
    return;
  const bool known = purpose == Purpose::start && !scene.start_from;
  scene.gravity->resting_contacts = known && choose_resting_contacts(scale_of(scene), scene).carried;
  if (known || purpose == Purpose::go_on)
    settings.resolve(key, std::string(scene.gravity->resting_contacts ? "carried" : "bounced"));
}

Scene read_scene(SceneDocument document, const std::string& name, Purpose purpose, std::vector<std::string> notices) {
  add_gravity_of_quality(document);
  check_document(document, name);
  Settings settings(std::move(document));
  Scene scene;
  scene.notices = std::move(notices);
  scene.title = settings.text("title");
  scene.planet = read_planet(settings);
  if (settings.has("start"))
    read_start(scene, settings, name);
  else if (purpose != Purpose::go_on)
    read_particles_and_box(scene, settings, name);
  else
    scene.particles.seed = static_cast<std::uint64_t>(settings.integer("particles.seed"));
  scene.moonlets = read_moonlets(settings, name);
  if (purpose != Purpose::go_on && !scene.start_from)
    check_placed_bodies(scene, settings);
  scene.collisions = read_collisions(settings, name);
  scene.gravity = read_gravity(settings, name, scene.size_x);
  scene.external_forces = read_external_forces(scene, settings, name);
  resolve_times_of_quality(scene, settings);
  read_times(scene, settings);
  read_resting_contacts(scene, settings, purpose);
  if (purpose == Purpose::start)
    refuse_many_oscillations(scene, settings);
  scene.output.collisions = read_contact_log(settings);
  scene.resolved = settings.resolved();
  scene.motion = settings.motion();
  return scene;
}

} // namespace

double ParticleSettings::bunching() const {
  double sum = streamlines.bunching;
  for (const ModeSettings& mode : modes)
    sum += mode.amplitude;
  return sum;
}

double Scene::step_length() const {
  return two_pi * time.step;
}

double Scene::surface_density() const {
  return optical_depth() * (start_from ? 0.0 : surface_density_per_depth(particles.sizes, particles.density));
}

double Scene::optical_depth() const {
  if (start_from)
    return 0.0;
  return static_cast<double>(particles.count) * pi * particles.sizes.mean_power(2) / (size_x * size_y);
}

double Scene::bunched_optical_depth() const {
  const double free = static_cast<double>(particles.free_count()) / static_cast<double>(particles.count);
  return free * optical_depth() * particles.pattern.peak() / (1.0 - particles.bunching());
}

Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                  const std::optional<std::string>& from) {
  SceneDocument document = parse_document(text, name);
  std::vector<std::string> notices;
  apply_overrides(document, overrides, notices);
  if (from)
    apply_start(document, *from, notices);
  return read_scene(std::move(document), name, Purpose::start, std::move(notices));
}

TableScene load_table_scene(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_table_scene(read_scene_text(path), path, overrides);
}

TableScene parse_table_scene(const std::string& text, const std::string& name,
                             const std::vector<std::string>& overrides) {
  SceneDocument document = parse_document(text, name);
  std::vector<std::string> notices;
  apply_overrides(document, overrides, notices);
  const bool has_density = find_entry(document, "particles.density") != nullptr;
  apply_table(document);
  TableScene of{read_scene(std::move(document), name, Purpose::table, std::move(notices)), {}};
  if (has_density)
    of.density = of.scene.particles.density;
  return of;
}

Scene load_varied_scene(const std::string& path, const std::vector<Override>& overrides) {
  SceneDocument document = parse_document(read_scene_text(path), path);
  std::vector<std::string> notices;
  for (const Override& by : overrides)
    apply_override(document, by, notices);
  return read_scene(std::move(document), path, Purpose::start, std::move(notices));
}

Scene parse_stored_scene(const std::string& text, const std::string& name) {
  SceneDocument document = parse_document(text, name);
  name_quality_of_stored(document, name);
  return read_scene(std::move(document), name, Purpose::go_on, {});
}

Scene load_stored_scene(const std::filesystem::path& file) {
  const std::string text = read_lines(file);
  try {
    return parse_stored_scene(text, file.string());
  } catch (const UsageError&) {
    throw IoError(fmt::format("'{}' is damaged: it is no scene of Keeler any more; put it back, or take that of a "
                              "snapshot (\"keeler info FILE --json\" prints it)",
                              file.string()));
  }
}

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                 const std::optional<std::string>& from) {
  return parse_scene(read_scene_text(path), path, overrides, from);
}

} // namespace keeler
