#include "state_cache.hpp"

#include "unit/files/disk.hpp"

#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <cstdlib>
#include <doctest/doctest.h>
#include <optional>
#include <string>

namespace state_cache_test {

using namespace keeler;
using namespace keeler::bench;

namespace {

Scene scene_with_seed(int seed) {
  return parse_scene("[planet]\npreset = \"saturn-a-ring\"\n[box]\nsize = [40, 40]\n[particles]\ncount = 50\n"
                     "density = 600.0\nsizes = { law = \"equal\", radius = 1.0 }\nseed = " +
                         std::to_string(seed) + "\n[time]\nend = 1.0\n",
                     "test");
}

// Counts how often the patch is made.
struct Maker {
  Scene scene = scene_with_seed(1);
  int made = 0;

  Patch patch(const std::filesystem::path& folder) {
    return cached_patch(folder, scene, [&] {
      ++made;
      return initial_patch(scene);
    });
  }
};

bool equal(const Patch& a, const Patch& b) {
  return a.positions == b.positions && a.velocities == b.velocities && a.radii == b.radii && a.masses == b.masses &&
         a.ids == b.ids && a.offset == b.offset && a.box.size_x == b.box.size_x;
}

// Sets an environment variable, or removes it for null, during its lifetime.
class Variable {
public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const former = std::getenv(name))
      former_ = former;
    set(value);
  }
  ~Variable() { set(former_ ? former_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  void set(const char* value) { value ? ::setenv(name_, value, 1) : ::unsetenv(name_); }

  const char* name_;
  std::optional<std::string> former_;
};

} // namespace

TEST_CASE("a state is made once, and read with the same bits") {
  const test::TemporaryFolder folder;
  Maker maker;
  const Patch first = maker.patch(folder / "new/folder");
  CHECK(first.size() == 50);
  CHECK(equal(maker.patch(folder / "new/folder"), first));
  CHECK(maker.made == 1);
  maker.scene = scene_with_seed(2);
  CHECK_FALSE(equal(maker.patch(folder / "new/folder"), first)); // another scene has a file of its own
  CHECK(maker.made == 2);
}

TEST_CASE("a state is made where none can be stored") {
  const test::TemporaryFolder folder;
  files::write_text(folder / "file", "");
  Maker maker;
  for (const std::filesystem::path& bad : {std::filesystem::path(), folder / "file/below"})
    CHECK(maker.patch(bad).size() == 50);
  CHECK(maker.made == 2);
  const test::SmallDisk full(1000);
  CHECK(maker.patch(folder / "full").size() == 50);
  CHECK(maker.made == 3);
}

TEST_CASE("a damaged state is made again") {
  const test::TemporaryFolder folder;
  Maker maker;
  const Patch first = maker.patch(folder.path());
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    std::filesystem::resize_file(entry.path(), 1000);
  CHECK(equal(maker.patch(folder.path()), first));
  CHECK(maker.made == 2);
  CHECK(equal(maker.patch(folder.path()), first));
  CHECK(maker.made == 2);
}

TEST_CASE("the cache folder is the user's") {
  const Variable home("HOME", "/home/saturn");
  {
    const Variable cache("XDG_CACHE_HOME", "/var/cache");
    CHECK(cache_folder() == "/var/cache/keeler");
  }
  {
    const Variable cache("XDG_CACHE_HOME", "relative");
    CHECK(cache_folder() == "/home/saturn/.cache/keeler");
  }
  const Variable cache("XDG_CACHE_HOME", nullptr), none("HOME", nullptr);
  CHECK(cache_folder().empty());
}

} // namespace state_cache_test
