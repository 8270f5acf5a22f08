#include "start_pattern_keys.hpp"

#include <string>

namespace keeler::scene {
namespace {

std::vector<Key> streamline_keys() {
  using enum KeyType;
  using enum KeyEffect;
  return {
      {.path = "particles.streamlines.waves",
       .type = integer,
       .example = "1",
       .unit = "1",
       .meaning = "number n of waves in the box: eccentricity vectors have the phases 2 pi n X / L_x at the start",
       .range = {.low = 1, .high = 1000},
       .effect = start},
      {.path = "particles.streamlines.bunching",
       .type = number,
       .example = "0.6",
       .unit = "1",
       .meaning = "q = (2 pi n / L_x) e of that pattern: streamlines bunch to 1 - q of their spacing once an orbit",
       .range = {.low = 0, .high = 0.9},
       .effect = start},
      {.path = "particles.streamlines.inclination",
       .type = number,
       .fallback = "0.0",
       .unit = "mean r",
       .meaning = "inclination common to all particles, which oscillate in phase; rising at the start",
       .range = {.low = 0, .high = 1000},
       .effect = start},
  };
}

std::vector<Key> mode_keys() {
  const auto key = [](const char* name, const char* meaning) {
    return Key{.path = std::string("particles.modes.") + name,
               .type = KeyType::rows,
               .fallback = "[]",
               .meaning = meaning,
               .range = {.low = -360, .high = 1000},
               .columns = {"waves in the box", "amplitude of the relative surface density",
                           "phase in degrees, with a crest at x = -phase/k"},
               .effect = KeyEffect::start};
  };
  return {key("outward", "epicyclic waves along the radius at the start that travel outward"),
          key("inward", "epicyclic waves along the radius at the start that travel inward"),
          key("standing", "standing epicyclic waves along the radius; their density is largest at the start")};
}

std::vector<Key> pattern_keys() {
  using enum KeyType;
  using enum KeyEffect;
  return {
      {.path = "particles.density_step.between",
       .type = pair,
       .example = "[-20.0, 20.0]",
       .unit = "m",
       .meaning = "x between which the surface density differs at the start; its mean over the box is kept",
       .range = {.low = -1e7, .high = 1e7},
       .effect = start},
      {.path = "particles.density_step.factor",
       .type = number,
       .example = "2.0",
       .unit = "1",
       .meaning = "surface density between these x over that outside; 0: a gap",
       .range = {.low = 0, .high = 100},
       .effect = start},
      {.path = "particles.wake.contrast",
       .type = number,
       .example = "0.5",
       .unit = "1",
       .meaning = "A of a surface density 1 + A cos(k r) at the start, with a crest through the centre",
       .range = {.low = 0, .high = 1, .low_open = true},
       .effect = start},
      {.path = "particles.wake.wavelength",
       .type = number,
       .example = "60.0",
       .unit = "m",
       .meaning = "distance between crests, rounded so that whole waves fit the box",
       .range = {.low = 0, .high = 1e7, .low_open = true},
       .effect = start},
      {.path = "particles.wake.pitch",
       .type = number,
       .fallback = "20.0",
       .unit = "degrees",
       .meaning = "angle of the crests to the orbit, rounded likewise; above 0 they trail, at 0 they are rings",
       .range = {.low = -90, .high = 90},
       .effect = start},
  };
}

} // namespace

std::vector<Key> start_pattern_keys() {
  std::vector<Key> all;
  for (const std::vector<Key>& keys : {streamline_keys(), mode_keys(), pattern_keys()})
    all.insert(all.end(), keys.begin(), keys.end());
  return all;
}

} // namespace keeler::scene
