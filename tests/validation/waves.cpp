#include "waves.hpp"

#include "rows.hpp"

#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cmath>
#include <complex>

namespace keeler::validation {

Wave seeded_wave(const WaveStart& start, std::vector<std::string> more) {
  more.insert(more.begin(), {fmt::format("box.size=[{},{}]", start.length, start.width),
                             fmt::format("particles.optical_depth={}", start.depth),
                             fmt::format("particles.modes.outward=[[1,{},0]]", start.amplitude),
                             fmt::format("time.end={}", start.end), "time.step=2e-3", "output.snapshot_every=0.25",
                             "output.series_every=0.1"});
  const Ran ran = run_example("equilibrium", more);
  Wave wave;
  wave.command = fmt::format("{}; keeler analyze DIR --since {}", ran.command, start.since);
  for (const Patch& patch : ran.snapshots)
    if (patch.time_orbits > start.since - 1e-9)
      wave.patches.push_back(patch);
  wave.growth = *diagnostics::analyze_radial_modes(wave.patches, 1)[0].growth;
  return wave;
}

diagnostics::Growth frequency_of(const Wave& wave) {
  std::vector<double> times, turns; // growth() fits a line through the logarithms: of exp(phase), through the phases
  double phase = 0.0;
  for (const Patch& patch : wave.patches) {
    const double kappa = patch.frequencies.kappa, time = two_pi * patch.time_orbits;
    const double next = std::arg(diagnostics::radial_modes(patch, 1)[0].outward(kappa) * std::polar(1.0, kappa * time));
    phase += std::remainder(next - phase, two_pi);
    times.push_back(time);
    turns.push_back(std::exp(phase));
  }
  diagnostics::Growth result = *diagnostics::growth(times, turns);
  result.rate = wave.patches.front().frequencies.kappa - result.rate;
  return result;
}

} // namespace keeler::validation
