#include <keeler/scene/keys.hpp>

#include "key_table.hpp"

namespace keeler::scene {

const config::Schema& scene_schema() {
  static const config::Schema schema(make_keys(), make_sections());
  return schema;
}

} // namespace keeler::scene
