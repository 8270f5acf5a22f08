#include <keeler/scene/keys.hpp>

#include "key_table.hpp"

namespace keeler {

const Schema& scene_schema() {
  static const Schema schema(make_keys(), make_sections());
  return schema;
}

} // namespace keeler
