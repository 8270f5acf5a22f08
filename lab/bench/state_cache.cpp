#include "state_cache.hpp"

#include <keeler/core/error.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/hash.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/snapshot.hpp>

#include <cstdlib>
#include <optional>
#include <system_error>

namespace keeler::bench {
namespace {

std::optional<std::filesystem::path> folder_in(const char* variable) {
  const char* const value = std::getenv(variable);
  return value && *value == '/' ? std::optional<std::filesystem::path>(value) : std::nullopt;
}

std::optional<Patch> stored(const std::filesystem::path& file, const Scene& scene) {
  try {
    io::Snapshot snapshot = io::read_snapshot(file);
    if (snapshot.meta.scene == scene.resolved)
      return initial_conditions::patch_from_snapshot(std::move(snapshot.patch), file.string(), scene);
  } catch (const Error&) { // absent or damaged: made again
  }
  return {};
}

void store(const std::filesystem::path& file, const Patch& patch, const Scene& scene) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    io::write_snapshot(file, patch, {scene.resolved, io::collect_provenance({})});
  } catch (const Error&) { // the next call makes it again
  }
}

} // namespace

std::filesystem::path cache_folder() {
  if (const auto cache = folder_in("XDG_CACHE_HOME"))
    return *cache / "keeler";
  const auto home = folder_in("HOME");
  return home ? *home / ".cache" / "keeler" : std::filesystem::path();
}

Patch cached_patch(const std::filesystem::path& folder, const Scene& scene, const std::function<Patch()>& make) {
  if (folder.empty())
    return make();
  io::Hash hash;
  hash.add_text(scene.resolved);
  const std::filesystem::path file = folder / ("bench-" + hash.hex() + ".hdf");
  if (std::optional<Patch> patch = stored(file, scene))
    return *std::move(patch);
  Patch made = make();
  store(file, made, scene);
  return stored(file, scene).value_or(std::move(made));
}

} // namespace keeler::bench
