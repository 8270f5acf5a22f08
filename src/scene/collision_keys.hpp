// The keys of collisions but those of the laws of restitution, which are registered (collision/restitution.hpp).
#pragma once

#include <keeler/core/key.hpp>

#include <vector>

namespace keeler::scene {

std::vector<Key> collision_keys();
/// Returns the keys that apply to every law of restitution.
std::vector<Key> restitution_keys();
std::vector<Key> friction_keys();

} // namespace keeler::scene
