#include <keeler/scene/keys.hpp>

#include "key_table.hpp"

#include <keeler/forces/force.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>

#include <array>
#include <list>
#include <mutex>

namespace keeler::scene {
namespace {

// A schema, and the lists of entries that it was made from: each is another one after an addition.
struct SchemaOf {
  std::array<const void*, 3> lists;
  config::Schema schema;
};

} // namespace

const config::Schema& scene_schema() {
  static std::mutex guard;
  static std::list<SchemaOf> schemas; // the last is in force; documents refer to earlier ones
  const std::array<const void*, 3> lists = {&forces::external_forces(), &particles::size_laws(),
                                            &particles::start_laws()};
  const std::lock_guard lock(guard);
  if (schemas.empty() || schemas.back().lists != lists)
    schemas.push_back({lists, config::Schema(make_keys(), make_sections())});
  return schemas.back().schema;
}

} // namespace keeler::scene
