// The scene of these tests: a patch with collisions and some clumping that runs in a fraction of a second.
#pragma once

#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::test {

inline Scene small_scene(const std::vector<std::string>& overrides = {}) {
  return parse_scene(R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [30.0, 25.0]
[particles]
count = 100
density = 500.0
sizes = { law = "power", exponent = 3.0, min = 0.3, max = 1.0 }
[gravity]
solver = "tree"
[time]
step = 5e-3
end = 1.0
[output]
snapshot_every = 0.5
)",
                     "test scene", overrides);
}

} // namespace keeler::test
