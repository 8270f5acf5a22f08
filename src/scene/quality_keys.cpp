#include "quality_keys.hpp"

#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/quality.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

constexpr double usual_hill = 0.94;                           // where the intervals were measured
constexpr double cheapest_drift = 0.3;                        // contacts per particle in a drift
constexpr double shortest_drift = 5e-4, longest_drift = 8e-3; // orbits; shorter and longer ones cost no less

double contacts_per_orbit(const Scene& scene) {
  constexpr double in_wakes = 230.0, in_a_layer = 20.0; // assumed for a state from a file
  if (scene.start_from)
    return scene.gravity ? in_wakes : in_a_layer;
  return scene_contacts(scene).wakes.all();
}

// Returns the largest 1, 2 or 5 times a power of ten up to the number: output times are multiples of it.
double round_part_of_an_orbit(double number) {
  assert(number > 0.0);
  const double ten = std::pow(10.0, std::floor(std::log10(number)));
  for (const double digit : {10.0, 5.0, 2.0})
    if (digit * ten <= number * (1.0 + 1e-9))
      return digit * ten;
  return ten;
}

// A kick gives touching spheres a closing speed g Δt; their mutual gravity is g = 3 r_h³ r Ω².
double kick_interval_of(const Quality& quality, const Scene& scene) {
  if (scene.start_from)
    return quality.kick_interval;
  const double hill = hill_parameter(scene.particles.density, distance_from_saturn(scene.planet));
  return round_part_of_an_orbit(quality.kick_interval * std::min(1.0, std::pow(usual_hill / hill, 3)));
}

// Returns a power of two: the cost of a drift depends little on its length within a factor of two.
std::int64_t drifts_in(double interval, double drift) {
  assert(interval > 0.0 && drift > 0.0);
  return std::int64_t{1} << std::llround(std::clamp(std::log2(interval / drift), 0.0, 9.0));
}

const Quality* quality_of(const std::string& name) {
  const auto found =
      std::find_if(qualities.begin(), qualities.end(), [&](const Quality& quality) { return name == quality.name; });
  return found == qualities.end() ? nullptr : &*found;
}

const std::string* word_in(const config::TomlDocument& document, const std::string& path) {
  const config::DocumentEntry* const entry = find_entry(document, path);
  return entry ? std::get_if<std::string>(&entry->value) : nullptr;
}

// Returns nullptr for "custom", and for values that check_document() refuses.
const Quality* quality_in(const config::TomlDocument& document) {
  if (!find_entry(document, "quality"))
    return quality_of(default_quality);
  const std::string* const name = word_in(document, "quality");
  return name ? quality_of(*name) : nullptr;
}

} // namespace

void add_gravity_of_quality(config::TomlDocument& document) {
  const Quality* const quality = quality_in(document);
  if (!quality || !find_entry(document, "gravity"))
    return;
  const auto add = [&](const std::string& path, config::DocumentValue value) {
    if (!find_entry(document, path))
      document.add({path, "quality", "quality", std::move(value), false});
  };
  const auto has = [&](const std::string& path) { return find_entry(document, path) != nullptr; };
  const bool for_tree = has("gravity.opening_angle") || has("gravity.images") || has("gravity.image_rings");
  add("gravity.solver", std::string(for_tree ? "tree" : "auto"));
  const std::string* const given = word_in(document, "gravity.solver");
  const std::string solver = given ? *given : "";
  if (solver == "fft" || solver == "auto")
    add("gravity.force_error", quality->force_error);
  if (solver == "tree")
    add("gravity.opening_angle", quality->opening_angle);
}

void name_quality_of_stored(config::TomlDocument& document, const std::string& name) {
  if (!find_entry(document, "quality"))
    document.add({"quality", name, name, std::string("custom"), false});
}

void resolve_times_of_quality(Scene& scene, config::Settings& settings) {
  assert(scene.planet.orbital_frequency > 0.0);
  const Quality* const quality = quality_of(settings.text("quality"));
  if (!quality || settings.is_word("time.step"))
    return;
  const bool kicks_given = scene.gravity && settings.given("gravity.kick_every");
  if (settings.given("time.step") && (kicks_given || !scene.gravity)) // as in the scene.toml of a run
    return;
  const bool has_forces = scene.gravity || !scene.external_forces.empty();
  const double interval = has_forces ? kick_interval_of(*quality, scene) : longest_drift;
  const double cheapest = std::clamp(cheapest_drift / contacts_per_orbit(scene), shortest_drift, longest_drift);
  std::int64_t drifts = scene.gravity ? drifts_in(interval, cheapest) : 1;
  if (settings.given("time.step"))
    drifts = std::clamp<std::int64_t>(std::llround(interval / settings.number("time.step")), 1, 1000);
  else {
    if (kicks_given)
      drifts = scene.gravity->kick_every;
    const double longest = interval / static_cast<double>(drifts);
    settings.resolve("time.step", scene.gravity ? longest : round_part_of_an_orbit(std::min(longest, cheapest)));
  }
  if (scene.gravity && !kicks_given) {
    scene.gravity->kick_every = static_cast<int>(drifts);
    settings.resolve("gravity.kick_every", drifts);
  }
}

} // namespace keeler::scene
