// Every number of a scene, with values that are absurd, not finite or at the ends of its range: either it is refused
// with its position when the scene is read, or a run of two steps ends normally or with a message.
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace key_ranges_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

// TOML by table and key.
using Tables = std::map<std::string, std::map<std::string, std::string>>;

// Replacements for example values that do not suit so small a scene.
const std::map<std::string, std::string> fitting = {
    {"moonlet.radius", "2.0"},
    {"moonlet.mass", "3e4"},
    {"moonlet.position", "[5.0, 5.0, 0.0]"},
    {"particles.aggregate.count", "8"},
    {"particles.count", "60"},
    {"particles.sizes.path", "[[1.0]]"},
    {"particles.sizes.table", "[[1.0, 1]]"},
    {"particles.sizes.populations", "[[1.0, 1, 450.0]]"},
    {"particles.wake.wavelength", "25.0"},
    {"particles.optical_depth", "0.1"},
    {"particles.surface_density", "100.0"},
    {"particles.modes.outward", "[[1, 0.1, 0.0]]"},
    {"particles.modes.inward", "[[1, 0.1, 0.0]]"},
    {"particles.modes.standing", "[[1, 0.1, 0.0]]"},
    {"collisions.restitution.table", "[[0.01, 0.5]]"},
    {"satellite.passage", "2e-3"},
};

std::string good_value(const Key& key) {
  const auto found = fitting.find(key.path);
  return found != fitting.end() ? found->second : key.example.empty() ? key.fallback : key.example;
}

bool is_number(const Key& key) {
  return key.type != KeyType::text && key.type != KeyType::path && key.type != KeyType::choice;
}

void put(Tables& tables, const Key& key, const std::string& value) {
  for (const std::string& other : key.alternatives)
    tables[scene::find_key(other)->section()].erase(scene::find_key(other)->name());
  tables[key.section()][key.name()] = value;
}

// Returns the other keys that the table of a key requires.
void put_around(Tables& tables, const Key& key) {
  const KeyCondition& needs = key.only_with;
  if (!needs.key.empty()) {
    const Key& other = *scene::find_key(needs.key);
    put(tables, other, needs.values.empty() ? good_value(other) : fmt::format("\"{}\"", needs.values.front()));
    for (const Key& sibling : scene::scene_keys()) // of a law
      if (sibling.only_with.key == needs.key && sibling.path != key.path && !needs.values.empty()) {
        tables[sibling.section()].erase(sibling.name());
        if (sibling.only_with.values == needs.values && sibling.fallback.empty())
          put(tables, sibling, good_value(sibling));
      }
  }
  std::map<std::string, std::string>& own = tables[key.section()];
  for (const Key& sibling : scene::scene_keys()) {
    const bool given = own.contains(sibling.name()) || sibling.path == key.path || !sibling.fallback.empty();
    bool instead = false;
    for (const std::string& other : sibling.alternatives)
      instead = instead || other == key.path ||
                tables[scene::find_key(other)->section()].contains(scene::find_key(other)->name());
    if (sibling.section() == key.section() && sibling.only_with.key.empty() && !given && !instead)
      own[sibling.name()] = good_value(sibling);
  }
}

Tables scene_around(const Key& key, const std::string& snapshot) {
  Tables tables = {{"planet", {{"orbital_frequency", "2e-4"}}},
                   {"box", {{"size", "[60.0, 50.0]"}}},
                   {"particles", {{"count", "60"}, {"density", "900.0"}}},
                   {"particles.sizes", {{"law", "\"equal\""}, {"radius", "1.0"}}},
                   {"collisions.restitution", {{"law", "\"constant\""}, {"value", "0.5"}}},
                   {"time", {{"step", "1e-3"}, {"end", "2e-3"}}}};
  put_around(tables, key);
  if (key.path == "box.size_in_wavelengths")
    put(tables, *scene::find_key("particles.optical_depth"), "0.1");
  if (key.path == "particles.modes.outward" || key.path == "particles.modes.inward" ||
      key.path == "particles.modes.standing")
    tables.erase("particles.streamlines");
  if (key.section() == "start") {
    for (const char* const table : {"box", "particles", "particles.sizes"})
      tables.erase(table);
    tables["start"]["from"] = "\"" + snapshot + "\"";
  }
  return tables;
}

std::string text_of(const Tables& tables) {
  std::string text;
  for (const auto& [table, keys] : tables)
    if (!keys.empty() || table == "gravity") {
      text += table.empty() ? "" : scene::find_section(table)->header() + "\n";
      for (const auto& [name, value] : keys)
        text += fmt::format("{} = {}\n", name, value);
    }
  return text;
}

// Returns a list once per element, with that number replaced; for a plain number the replacement.
std::vector<std::string> with_each_replaced(const std::string& list, const std::string& number) {
  constexpr const char* digits = "-+.0123456789e";
  std::vector<std::string> all;
  for (std::size_t begin = 0; (begin = list.find_first_of(digits, begin)) != std::string::npos;) {
    const std::size_t end = std::min(list.find_first_not_of(digits, begin), list.size());
    all.push_back(list.substr(0, begin) + number + list.substr(end));
    begin = end;
  }
  return all;
}

std::vector<std::string> tried_values(const Key& key) {
  std::vector<std::string> numbers = {"1e300", "-1e300", "1e-300", "nan", "inf", "-inf", "0.0", "1e30", "-1e30"};
  for (const double end : {key.range.low, key.range.high})
    numbers.push_back(fmt::format("{}", end));
  if (key.type == KeyType::integer)
    for (const char* const whole : {"9223372036854775807", "-9223372036854775808", "18446744073709551615", "0", "1.5"})
      numbers.emplace_back(whole);
  std::vector<std::string> values;
  const bool alone = key.type == KeyType::number || key.type == KeyType::integer;
  for (const std::string& number : numbers)
    for (const std::string& value : alone ? std::vector{number} : with_each_replaced(good_value(key), number))
      values.push_back(value);
  return values;
}

bool is_about_the_scene(const std::string& fault) {
  return fault.starts_with("s.toml:");
}

// Returns the message for the user, empty if there is none.
std::string outcome(const std::string& text, const std::filesystem::path& folder) {
  Scene scene;
  try {
    scene = parse_scene(text, "s.toml");
  } catch (const UsageError& fault) {
    return is_about_the_scene(fault.what()) ? "" : std::string("check: ") + fault.what();
  }
  if (scene.particles.count > 10000) // as large as the machine allows
    return "";
  const std::int64_t kick = scene.kick_interval();
  scene.time.end_step = kick == 1 ? 2 : kick;
  RunRequests requests;
  RunOptions options;
  options.folder = folder;
  options.force = true;
  try {
    start_run(scene, options, requests);
  } catch (const Error& fault) {
    const std::string said = fault.what();
    return said.find("energy") == std::string::npos && said.find("nan") == std::string::npos ? "" : "run: " + said;
  }
  return "";
}

} // namespace

TEST_CASE("every number has both ends of a range") {
  for (const Key& key : scene::scene_keys())
    if (is_number(key)) {
      CAPTURE(key.path);
      CHECK(std::isfinite(key.range.low));
      CHECK(std::isfinite(key.range.high));
    }
}

TEST_CASE("an absurd number is refused with its place, or two steps go well") {
  set_threads(1); // hundreds of very short runs
  const TemporaryFolder work;
  const std::string snapshot = (work / "start.hdf").string();
  const Key& size = *scene::find_key("box.size");
  const Scene fresh = parse_scene(text_of(scene_around(size, snapshot)), "s.toml");
  io::write_snapshot(snapshot, initial_patch(fresh), {fresh.resolved, {}});
  for (const Key& key : scene::scene_keys()) {
    if (!is_number(key))
      continue;
    Tables tables = scene_around(key, snapshot);
    put(tables, key, good_value(key));
    CAPTURE(key.path);
    CHECK_NOTHROW(parse_scene(text_of(tables), "s.toml"));
    for (const std::string& value : tried_values(key)) {
      tables[key.section()][key.name()] = value;
      CAPTURE(value);
      CHECK(outcome(text_of(tables), work / "run") == "");
    }
  }
}

} // namespace key_ranges_test
