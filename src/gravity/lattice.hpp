// The exact field of one unit mass with all its images, open in z: the reference of every shear-periodic solver, pair
// by pair.
//
// Ewald's sum for a sheet (e.g. Koyama & Ostriker 2009, ApJ 693, 1316, for the waves' part): near images with their
// attraction cut off beyond a few split lengths, and the rest as waves e^{ik·r} with the 3-D Gaussian's profile across
// the plane. The wave k = 0 is the mean sheet, which attracts by 2π/A far above it and not along it. Units: G = 1.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler::gravity {

/// A wave that is periodic in the sheared box; one of each pair ±k.
struct LatticeWave {
  double kx, ky, k; ///< rad/m
};

class Lattice {
public:
  /// Prepares the sums for a box at a shear offset. Terms below `tolerance` (in (0, 1)) of the largest are omitted. The
  /// split length, in sides of a square box of equal area, does not change results, only the ratio of images to waves;
  /// the default balances both.
  Lattice(const ShearingBox& box, double offset, double tolerance = 1e-15, double relative_split = 0.237);

  /// Returns the acceleration (1/m²) at a displacement from the mass. An image exactly there does not act.
  Vec3 acceleration(const Vec3& displacement) const;

  /// Returns the potential (1/m) at a displacement. Its zero is that of the sums: the wave k = 0 gives +2π/A |z| far
  /// from the plane. An image exactly there is omitted.
  double potential(const Vec3& displacement) const;

  /// r_s: near images decay as erfc(d / 2 r_s), waves as e^{−k² r_s²}.
  double split_length() const { return split_; }

  /// Distance beyond which near images are omitted, m.
  double reach() const { return reach_; }

  const std::vector<LatticeWave>& waves() const { return waves_; }

  /// Returns the factor of cos(k·r) in the potential at height z, 2 φ_k(z) / A.
  double wave_potential(const LatticeWave& wave, double z) const;

  /// Returns the contribution of the mean sheet to the potential at height z.
  double sheet_potential(double z) const;

  /// Returns the shifts (m) of the images with |shift| ≤ distance, in a fixed order.
  std::vector<Vec3> shifts_within(double distance) const;

private:
  ShearingBox box_;
  double offset_, split_, reach_;
  std::vector<Vec3> near_; // all shifts that may act on a position in the cell
  std::vector<LatticeWave> waves_;
};

} // namespace keeler::gravity
