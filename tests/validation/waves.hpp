// Runs of a ring with one axisymmetric wave, as long as the box, that is there at the start.
#pragma once

#include <keeler/diagnostics/radial_modes.hpp>
#include <keeler/particles/patch.hpp>

#include <string>
#include <vector>

namespace keeler::validation {

/// The wave travels outward at the start.
struct WaveStart {
  double amplitude = 0.05; ///< of the surface density
  double length = 0.0;     ///< of the wave, and of the box along the radius, m
  double width = 0.0;      ///< of the box along the orbit, m
  double depth = 0.0;      ///< optical depth
  double since = 3.0;      ///< orbit from which the wave is measured, to the end; the layer relaxes within one
  double end = 24.0;       ///< orbits
};

struct Wave {
  std::string command;
  std::vector<Patch> patches; ///< since WaveStart::since
  diagnostics::Growth growth; ///< in Ω
};

/// Runs examples/equilibrium with that wave and further keys.
Wave seeded_wave(const WaveStart& start, std::vector<std::string> more);

/// Returns the frequency of the outward wave, which goes as exp(i(kx - wt)), in Ω, with its error: κ less the rate of
/// its phase against epicycles without forces.
diagnostics::Growth frequency_of(const Wave& wave);

} // namespace keeler::validation
