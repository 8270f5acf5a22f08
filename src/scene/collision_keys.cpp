#include "collision_keys.hpp"

#include <keeler/finders/finders.hpp>

#include <string>

namespace keeler::scene {
namespace {

std::vector<std::string> finder_names() {
  std::vector<std::string> names;
  for (const finders::FinderEntry& finder : finders::finder_table())
    names.emplace_back(finder.name);
  return names;
}

} // namespace

std::vector<Key> collision_keys() {
  using enum KeyType;
  return {
      {.path = "collisions.finder",
       .type = choice,
       .fallback = "\"certified\"",
       .meaning = "method that finds the times of contact",
       .choices = finder_names()},
      {.path = "collisions.elastic_below_speed",
       .type = number,
       .fallback = "1e-2",
       .unit = "(r_i + r_j) Omega / 2",
       .meaning = "contacts slower than this bounce elastically, which ends inelastic collapse",
       .range = {.low = 0, .high = 100},
       .former_name = "elastic_below"},
  };
}

std::vector<Key> restitution_keys() {
  return {
      {.path = "collisions.restitution.max_coefficient",
       .type = KeyType::number,
       .fallback = "1.0",
       .unit = "1",
       .meaning =
           "upper limit of the coefficient of restitution for impacts faster than elastic_below_speed; below 1 for "
           "piles that are to come to rest",
       .range = {.low = 0, .high = 1},
       .former_name = "largest",
       .unhashed = "1.0"},
  };
}

std::vector<Key> friction_keys() {
  using enum KeyType;
  return {
      {.path = "collisions.friction.tangential_restitution",
       .type = number,
       .example = "0.5",
       .unit = "1",
       .meaning = "slip velocity of the surfaces after a contact over that before, if they do not slide throughout it",
       .range = {.low = -1, .high = 1}},
      {.path = "collisions.friction.coefficient",
       .type = number,
       .fallback = "\"unlimited\"",
       .unit = "1",
       .meaning = "Coulomb's coefficient: the tangential impulse is at most this times the normal impulse",
       .range = {.low = 0, .high = 1e6},
       .choices = {"unlimited"}},
  };
}

} // namespace keeler::scene
