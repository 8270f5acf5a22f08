// Uses the installed package: an epicycle must close after one turn of a Kepler orbit.
#include <cstdio>

double gap_after_one_orbit(); // m

int main() {
  const double gap = gap_after_one_orbit();
  std::printf("gap after one orbit: %.2g m\n", gap);
  return gap < 1e-11 ? 0 : 1; // rounding of a hundred steps, at lengths below 1 m
}
