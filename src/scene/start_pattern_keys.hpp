// The keys of the patterns that a fresh start may have: streamlines, radial modes, a step or a wave of the density.
#pragma once

#include <keeler/core/key.hpp>

#include <vector>

namespace keeler::scene {

std::vector<Key> start_pattern_keys();

} // namespace keeler::scene
