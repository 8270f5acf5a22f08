#include <keeler/scene/load.hpp>

#include "moonlets.hpp"
#include "particles_and_box.hpp"
#include "placed_bodies.hpp"
#include "presets.hpp"
#include "quality_keys.hpp"
#include "start_source.hpp"
#include "times.hpp"

#include <keeler/config/checks.hpp>
#include <keeler/config/settings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/scene/examples.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/resting_choice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace keeler::scene {
namespace {

PlanetSettings read_planet(config::Settings& settings) {
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

std::optional<collision::Friction> read_friction(const config::Settings& settings) {
  if (!settings.has("collisions.friction"))
    return {};
  const std::string coefficient = "collisions.friction.coefficient";
  return collision::Friction{settings.number("collisions.friction.tangential_restitution"),
                             settings.is_word(coefficient) ? collision::Friction::unlimited
                                                           : settings.number(coefficient)};
}

collision::CollisionSettings read_collisions(config::Settings& settings, const std::string& name) {
  collision::CollisionSettings collisions;
  collisions.finder = settings.text("collisions.finder");
  collisions.elastic_below = settings.number("collisions.elastic_below_speed");
  collisions.restitution = make_law(collision::restitution_laws(), "collisions.restitution", settings, name);
  if (const double largest = settings.number("collisions.restitution.max_coefficient"); largest < 1.0)
    collisions.restitution = [law = collisions.restitution, largest](const Impact& impact) {
      return std::min(largest, law(impact));
    };
  collisions.friction = read_friction(settings);
  return collisions;
}

// `size_x`: of the box; 0 if a start file holds it: then the solver checks its settings later.
std::optional<GravitySettings> read_gravity(config::Settings& settings, const std::string& name, double size_x) {
  if (!settings.has("gravity"))
    return {};
  const GravitySettings gravity = forces::gravity_settings(settings.parameters("gravity", name));
  if (size_x > 0.0 && gravity.solver == GravitySettings::Solver::axisymmetric)
    if (const std::string fault = gravity::radial_mesh_fault(size_x, gravity.shortest_wavelength); !fault.empty())
      config::fail_at(settings.location("gravity.shortest_wavelength"), fault);
  return gravity;
}

// If the box is known, each force is constructed once, so that its checks run now.
std::vector<ForceSettings> read_external_forces(const Scene& scene, config::Settings& settings,
                                                const std::string& name) {
  const forces::ForceContext context{.masses = {},
                                     .box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0},
                                     .orbital_frequency = scene.planet.orbital_frequency};
  std::vector<ForceSettings> forces;
  for (const forces::ForceEntry& entry : forces::external_forces()) {
    if (!settings.has(entry.table))
      continue;
    forces.push_back({&entry, settings.parameters(entry.table, name)});
    try {
      if (scene.size_x > 0.0 && entry.check)
        entry.check(forces.back().parameters, scene.size_x);
      if (scene.size_x > 0.0)
        entry.make(forces.back().parameters, context);
    } catch (const UsageError& fault) {
      config::fail_at(settings.location(entry.table), fault.what());
    }
  }
  return forces;
}

std::optional<ContactLogSettings> read_contact_log(config::Settings& settings) {
  if (!settings.has("output.collisions"))
    return {};
  return ContactLogSettings{
      settings.number("output.collisions.min_speed"), settings.number("output.collisions.min_radius_sum"),
      settings.number("output.collisions.fraction"), settings.text("output.collisions.at_rest") == "logged"};
}

void read_start(Scene& scene, config::Settings& settings, const std::string& name) {
  scene.start_from = settings.file_path("start.from", name);
  scene.start_keep = settings.number("start.keep_fraction");
  scene.start_keep_seed = static_cast<std::uint64_t>(settings.integer("start.keep_seed"));
}

enum class Purpose { start, table, resume }; // table: the scene's particles are placeholders

// If the particles come from a file, a table or the calling program, decided_by() makes the choice later. Stored scenes
// without a choice are of versions that bounced all contacts.
void read_resting_contacts(Scene& scene, config::Settings& settings, Purpose purpose) {
  const char* const key = "gravity.resting_contacts";
  if (!scene.gravity || !settings.has(key) || settings.text(key) != "auto")
    return;
  const bool known = purpose == Purpose::start && !scene.start_from && !scene.particles.start;
  scene.gravity->resting_contacts = known && choose_resting_contacts(scale_of(scene), scene.planet).carried;
  if (known || purpose == Purpose::resume)
    settings.resolve(key, std::string(scene.gravity->resting_contacts ? "carried" : "bounced"));
}

Scene read_scene(config::TomlDocument document, const std::string& name, Purpose purpose,
                 std::vector<std::string> notices) {
  const std::vector<std::string> former_names = former_name_notices(document);
  add_gravity_of_quality(document);
  check_document(document, name);
  config::Settings settings(std::move(document));
  Scene scene;
  scene.notices = std::move(notices);
  if (purpose != Purpose::resume)
    std::ranges::copy(former_names, std::back_inserter(scene.notices));
  scene.title = settings.text("title");
  scene.planet = read_planet(settings);
  if (settings.has("start"))
    read_start(scene, settings, name);
  else if (purpose != Purpose::resume)
    read_particles_and_box(scene, settings, name);
  else
    scene.particles.seed = static_cast<std::uint64_t>(settings.integer("particles.seed"));
  scene.moonlets = read_moonlets(settings, name);
  if (purpose != Purpose::resume && !scene.start_from)
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

Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                  const std::optional<std::string>& from) {
  config::TomlDocument document = parse_document(text, name, scene_schema());
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
  config::TomlDocument document = parse_document(text, name, scene_schema());
  std::vector<std::string> notices;
  apply_overrides(document, overrides, notices);
  const bool has_density = find_entry(document, "particles.density") != nullptr;
  apply_table(document);
  TableScene of{read_scene(std::move(document), name, Purpose::table, std::move(notices)), {}};
  if (has_density)
    of.density = of.scene.particles.density;
  return of;
}

Scene load_varied_scene(const std::string& path, const std::vector<config::Override>& overrides) {
  config::TomlDocument document = parse_document(read_scene_text(path), path, scene_schema());
  std::vector<std::string> notices;
  for (const config::Override& by : overrides)
    apply_override(document, by, notices);
  return read_scene(std::move(document), path, Purpose::start, std::move(notices));
}

namespace {

// The stored scene has a table, a key or a law that this program lacks: another program has added it.
struct ForeignScene : UsageError {
  using UsageError::UsageError;
};

void require_known(const config::TomlDocument& document, const std::string& name) {
  for (const config::DocumentEntry& entry : document) {
    const Key* const key = find_key(entry.path);
    const auto* const word = std::get_if<std::string>(&entry.value);
    const bool is_law = key && key->type == KeyType::choice && key->name() == "law" && word;
    if (is_law ? std::ranges::count(key->choices, *word) == 0 : !key && !find_section(entry.path))
      throw ForeignScene(fmt::format("the scene of '{}' has {}, which this program does not know; continue in the "
                                     "program that made it",
                                     name, is_law ? entry.path + " = " + config::to_toml(entry.value) : entry.path));
  }
}

} // namespace

Scene parse_stored_scene(const std::string& text, const std::string& name) {
  config::TomlDocument document = parse_document(text, name, scene_schema());
  require_known(document, name);
  name_quality_of_stored(document, name);
  return read_scene(std::move(document), name, Purpose::resume, {});
}

Scene load_stored_scene(const std::filesystem::path& file) {
  const std::string text = files::read_lines(file);
  try {
    return parse_stored_scene(text, file.string());
  } catch (const ForeignScene& foreign) {
    throw IoError(foreign.what());
  } catch (const UsageError&) {
    throw IoError(fmt::format("'{}' is damaged: it is no longer a scene of Keeler; restore it, or use the scene in a "
                              "snapshot (\"keeler info FILE --json\" prints it)",
                              file.string()));
  }
}

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                 const std::optional<std::string>& from) {
  return parse_scene(read_scene_text(path), path, overrides, from);
}

bool leaves_resting_open(const Scene& scene) {
  return scene.resolved.find("\nresting_contacts = \"auto\"\n") != std::string::npos;
}

Scene decided_by(const Scene& scene, const PatchScale& start) {
  if (!leaves_resting_open(scene))
    return scene;
  const RestingChoice choice = choose_resting_contacts(start, scene.planet);
  const char* const word = choice.carried ? "carried" : "bounced";
  Scene decided = parse_scene(scene.resolved, "the resolved scene", {fmt::format("gravity.resting_contacts={}", word)});
  decided.notices = scene.notices;
  return decided;
}

} // namespace keeler::scene
