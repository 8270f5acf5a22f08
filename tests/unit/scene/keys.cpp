#include "scenes.hpp"

#include <keeler/scene/keys.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace keys_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

TEST_CASE("the key table is consistent") {
  std::set<std::string> paths;
  for (const Key& key : scene_keys()) {
    CAPTURE(key.path);
    CHECK(paths.insert(key.path).second);
    CHECK((key.section().empty() || find_section(key.section())));
    CHECK(key.fallback.empty() != key.example.empty()); // every key has exactly one of them
    CHECK(!key.meaning.empty());
    CHECK(key.choices.empty() ==
          (key.type != KeyType::choice && key.path != "time.step" && key.path != "collisions.friction.coefficient"));
    CHECK((key.type == KeyType::rows) == !key.columns.empty());
    if (!key.only_with.key.empty())
      CHECK(find_key(key.only_with.key));
    for (const std::string& other : key.alternatives) {
      REQUIRE(find_key(other));
      const auto& back = find_key(other)->alternatives;
      CHECK(std::find(back.begin(), back.end(), key.path) != back.end());
    }
  }
}

TEST_CASE("every former name leads to its key, with a notice, and the resolved scene has the present one") {
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"particles.step={ between = [-5, 10], factor = 2.0 }", "particles.density_step"},
      {"particles.aggregate=[{ count = 9, filling = 0.3 }]", "particles.aggregate.filling_factor"},
      {"particles.aggregate=[{ count = 9, place = [1, 2, 3] }]", "particles.aggregate.position"},
      {"moonlet=[{ radius = 2, mass = 1e4, place = [1, 2, 3] }]", "moonlet.position"},
      {"collisions.elastic_below=0.02", "collisions.elastic_below_speed"},
      {"collisions.restitution={ law = \"viscoelastic\", speed = 0.01, reference_radius = 1 }",
       "collisions.restitution.reference_speed"},
      {"collisions.restitution={ law = \"viscoelastic\", reference_speed = 0.01, radius = 1 }",
       "collisions.restitution.reference_radius"},
      {"collisions.restitution.largest=0.9", "collisions.restitution.max_coefficient"},
      {"satellite={ mass = 1e7, distance = 500, passage = 1, upright_after = 2 }", "satellite.downstream_time"},
      {"start={ from = \"a.hdf\", keep = 0.5 }", "start.keep_fraction"},
      {"output.collisions.share=0.5", "output.collisions.fraction"}};
  std::set<std::string> tested;
  for (const auto& [changed, path] : changes) {
    const std::string& override = changed; // clang 14 captures no structured binding
    CAPTURE(override);
    const Scene scene = parse_scene(least, "s.toml", {override});
    CHECK(scene.notices.back().ends_with("' is now called '" + path + "'"));
    CHECK(parse_stored_scene(scene.resolved, "s.toml").notices.empty());
    CHECK(parse_scene(scene.resolved, "s.toml").notices.empty());
    tested.insert(path);
  }
  for (const Key& key : scene_keys())
    CHECK((key.former_name.empty() || tested.contains(key.path)));
  for (const config::Section& section : scene_sections())
    CHECK((section.former_path.empty() || tested.contains(section.path)));
}

TEST_CASE("former names change neither a stored scene's notices nor what its hash is made from") {
  const std::string text = least + "[collisions]\nelastic_below = 0.02\n";
  const Scene former = parse_scene(text, "s.toml");
  CHECK(former.notices ==
        std::vector<std::string>{
            "s.toml:12:1: 'collisions.elastic_below' is now called 'collisions.elastic_below_speed'"});
  CHECK(former.motion == parse_scene(changed(text, "below", "below_speed"), "s.toml").motion);
  CHECK(former.motion.find("\ncollisions.elastic_below = 0.02\n") != std::string::npos);
  CHECK(former.collisions.elastic_below == 0.02);
  CHECK(parse_stored_scene(text, "s.toml").notices.empty());
  CHECK(fault(text + "elastic_below_speed = 0.02\n").find("s.toml:13:1: collisions.elastic_below cannot") == 0);
}

TEST_CASE("the manual's table of keys equals the program's") {
  std::ifstream file(KEELER_SOURCE_DIR "/docs/manual/scene.md");
  std::ostringstream text;
  text << file.rdbuf();
  CHECK(text.str().find("\n\n" + describe_keys(true) + "\n") != std::string::npos);
}

TEST_CASE("the text table has one line per key") {
  const std::string table = describe_keys(false);
  for (const Key& key : scene_keys())
    CHECK(table.find("\n" + key.path + " ") != std::string::npos);
}

TEST_CASE("keys are described by their path, their last part, or their table") {
  const auto lines = [](const std::string& name) {
    const std::string table = describe_keys_called(name);
    return std::count(table.begin(), table.end(), '\n');
  };
  for (const Key& key : scene_keys())
    CHECK(describe_keys_called(key.path).find("\n" + key.path + " ") != std::string::npos);
  CHECK(lines("gravity.kick_every") == 2); // with the titles
  CHECK(lines("kick_every") == 2);
  CHECK(lines("particles.streamlines") == 4);
  CHECK(lines("friction") == lines("collisions.friction"));
  CHECK(lines("kick") == 0);
  CHECK(lines("") == 0);
}

} // namespace keys_test
