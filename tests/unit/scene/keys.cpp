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

} // namespace keys_test
