#include <keeler/diagnostics/wake_spectrum.hpp>

#include "density_mesh.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::diagnostics {
namespace {

constexpr double min_significance = 5.0;

// Returns the attenuation by a cloud of a wave with this phase difference from node to node.
double cloud_window(double turn) {
  const double half = 0.5 * turn;
  const double sinc = half == 0.0 ? 1.0 : std::sin(half) / half;
  return sinc * sinc;
}

// Bins of 0.25 × 2π/λ_cr, the last unbounded, and of 15° about multiples of 15°, since many waves are along x.
std::size_t bin_of(double kx, double ky, double critical_wavelength) {
  const double length = 4.0 * std::hypot(kx, ky) * critical_wavelength / two_pi;
  const double turns = std::atan2(ky, kx) / pi * WakePower::directions + 0.5; // ky ≥ 0
  return static_cast<std::size_t>(std::min(length, WakePower::lengths - 1.0)) * WakePower::directions +
         static_cast<std::size_t>(turns) % WakePower::directions;
}

} // namespace

WakePower& WakePower::operator+=(const WakePower& more) {
  for (std::size_t b = 0; b < bins.size(); ++b) {
    bins[b].power += more.bins[b].power;
    bins[b].k += more.bins[b].k;
    bins[b].k_radial += more.bins[b].k_radial;
  }
  power += more.power;
  cosine += more.cosine;
  sine += more.sine;
  noise_squares += more.noise_squares;
  snapshots += more.snapshots;
  return *this;
}

WakePower wake_power(const Patch& patch, double critical_wavelength) {
  const ShearingBox& box = patch.box;
  const auto [columns, rows] = mesh_size(patch);
  const double dx = box.size_x / columns, dy = box.size_y / rows;
  WakePower sums;
  if (!(critical_wavelength > 4.0 * std::max(dx, dy)))
    return sums;
  sums.snapshots = 1;
  MeshTransform mesh(columns, rows);
  const SelfPairs self = density_waves(patch, mesh);
  const double nodes = static_cast<double>(columns) * rows, shot = shot_power(patch);
  const double length = wake_smoothing * critical_wavelength;

  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows / 2; ++j) {
      if (j == 0 && (i == 0 || i > columns / 2)) // the mean, and the opposites of waves already counted
        continue;
      const double ky = two_pi * j / box.size_y, shear = ky * patch.offset / box.size_x;
      double kx = two_pi * i / box.size_x + shear;
      const double period = two_pi / dx;
      kx -= period * std::round(kx / period); // the longest of all waves that are equal on the mesh
      const double k = std::hypot(kx, ky), filter = std::exp(-k * k * length * length);
      if (filter < 1e-9)
        continue;
      const double window = cloud_window(kx * dx) * cloud_window(ky * dy), weight = filter / (window * window);
      const double noise = self.wave(kx * dx, ky * dy) / nodes;
      const double power = weight * (std::norm(mesh.waves_of(i)[j]) / (nodes * nodes) - noise);
      WakePower::Bin& bin = sums.bins[bin_of(kx, ky, critical_wavelength)];
      bin.power += power;
      bin.k += power * k;
      bin.k_radial += power * std::fabs(kx);
      sums.power += power;
      sums.cosine += power * (kx * kx - ky * ky) / (k * k);
      sums.sine += power * 2.0 * kx * ky / (k * k);
      sums.noise_squares += filter * filter * shot * shot; // |Σ|² of a random wave is exponential about its mean
    }
  return sums;
}

WakeWaves wake_waves(const WakePower& sums) {
  WakeWaves waves;
  if (sums.snapshots == 0)
    return waves;
  assert(sums.noise_squares >= 0.0);
  waves.contrast = std::sqrt(2.0 * std::max(0.0, sums.power) / sums.snapshots);
  if (std::hypot(sums.cosine, sums.sine) <= min_significance * std::sqrt(sums.noise_squares))
    return waves;
  WakePower::Bin total;
  for (const WakePower::Bin& bin : sums.bins)
    if (bin.power > 0.0) {
      total.power += bin.power;
      total.k += bin.k;
      total.k_radial += bin.k_radial;
    }
  waves.wavelength = two_pi * total.power / total.k;
  waves.radial_wavelength = two_pi * total.power / total.k_radial;
  waves.angle_degrees = 0.5 * std::atan2(sums.sine, sums.cosine) * 180.0 / pi;
  return waves;
}

} // namespace keeler::diagnostics
