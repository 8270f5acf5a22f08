// A small schema for the tests of this folder.
#pragma once

#include <keeler/config/schema.hpp>

namespace keeler::test {

inline const config::Schema& schema() {
  static const config::Schema all(
      {{.path = "title", .fallback = "\"\"", .meaning = "a name", .effect = KeyEffect::output},
       {.path = "gravity.solver", .type = KeyType::choice, .fallback = "\"tree\"", .choices = {"tree", "fft"}},
       {.path = "gravity.opening_angle",
        .type = KeyType::number,
        .fallback = "0.6",
        .only_with = {"gravity.solver", {"tree"}}},
       {.path = "gravity.force_error",
        .type = KeyType::number,
        .fallback = "2e-3",
        .only_with = {"gravity.solver", {"fft"}}},
       {.path = "moonlet.radius",
        .type = KeyType::number,
        .example = "1.0",
        .range = {.low = 0.0},
        .effect = KeyEffect::start,
        .former_name = "size"},
       {.path = "start.keep", .type = KeyType::number, .example = "0.5", .effect = KeyEffect::start},
       {.path = "time.end", .type = KeyType::number, .example = "3.0", .alternatives = {"time.steps"}},
       {.path = "time.steps",
        .type = KeyType::integer,
        .example = "3",
        .alternatives = {"time.end"},
        .former_name = "kicks"}},
      {{.path = "gravity"},
       {.path = "moonlet", .repeated = true, .max_count = 3},
       {.path = "start", .former_path = "begin"},
       {.path = "time", .needed = true, .meaning = "it ends"}});
  return all;
}

} // namespace keeler::test
