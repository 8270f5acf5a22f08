#include <keeler/diagnostics/wake_geometry.hpp>

#include <keeler/diagnostics/wake_spectrum.hpp>

#include <cassert>

namespace keeler::diagnostics {
namespace {

// Values of the snapshots that have one, to measure their scatter.
struct Singles {
  std::vector<double> values;
  void add(const std::optional<double>& value) {
    if (value)
      values.push_back(*value);
  }
};

} // namespace

WakeGeometry wake_geometry(std::span<const Patch> patches, double critical_wavelength) {
  assert(!patches.empty());
  WakePower sums;
  Singles wavelengths, radial_wavelengths, angles, inner, outer;
  for (const Patch& patch : patches) {
    const WakePower power = wake_power(patch, critical_wavelength);
    sums += power;
    const WakeWaves waves = wake_waves(power);
    wavelengths.add(waves.wavelength);
    radial_wavelengths.add(waves.radial_wavelength);
    angles.add(waves.angle_degrees);
    const Wakes ridge = find_wakes(mean_autocorrelation({&patch, 1}), critical_wavelength);
    inner.add(ridge.inner_pitch_degrees);
    outer.add(ridge.outer_pitch_degrees);
  }
  const WakeWaves waves = wake_waves(sums);
  WakeGeometry geometry;
  geometry.mean = find_wakes(mean_autocorrelation(patches), critical_wavelength);
  geometry.contrast = waves.contrast;
  geometry.wavelength = statistics::measured(waves.wavelength, wavelengths.values);
  geometry.radial_wavelength = statistics::measured(waves.radial_wavelength, radial_wavelengths.values);
  geometry.angle_degrees = statistics::measured_direction(waves.angle_degrees, angles.values);
  geometry.inner_pitch_degrees = statistics::measured_direction(geometry.mean.inner_pitch_degrees, inner.values);
  geometry.outer_pitch_degrees = statistics::measured_direction(geometry.mean.outer_pitch_degrees, outer.values);
  return geometry;
}

} // namespace keeler::diagnostics
