// Uses the installed package: an epicycle must close after one turn of a Kepler orbit.
#include <keeler/core/units.hpp>
#include <keeler/orbit/elements.hpp>

#include <cstdio>

int main() {
  const keeler::Frequencies kepler;
  keeler::Elements orbit;
  orbit.e_cos = 0.3;
  orbit.i_sin = 0.2;
  const keeler::State start = keeler::state_at(orbit, kepler, keeler::Rotation(kepler, 0.0));
  const keeler::State end = keeler::state_at(orbit, kepler, keeler::Rotation(kepler, keeler::two_pi));
  const double gap = (end.position - start.position).norm();
  std::printf("gap after one orbit: %.2g m\n", gap);
  return gap < 1e-12 ? 0 : 1; // rounding of 2 pi and of the rotation, at lengths below 1 m
}
